"""Matrices: sums of blocks, scikit-fem's own Argyris element as an oracle, and integrals up to a curved rim."""

import numpy as np
import pytest
from scipy.sparse import coo_matrix
from skfem import Basis, BilinearForm, ElementTriArgyris, MeshTri
from skfem.helpers import dd, ddot, trace

from fem_plate.elements.argyris import DERIVATIVES, EDGES
from fem_plate.elements.assembly import numbered, sum_up
from fem_plate.elements.space import PlateSpace
from fem_plate.sections import bending_law
from meshes import PlateMesh, annulus, disc, ellipse, polygon, rectangle


@pytest.mark.parametrize("seed", range(4))
def test_blocks_sum_up_to_what_triplets_do(seed, monkeypatch):
    rng = np.random.default_rng(seed)
    points, edges, m = 9, 14, 50
    of_points = np.array([rng.choice(points, 3, replace=False) for _ in range(m)])
    of_edges = points + np.array([rng.choice(edges - 2, 3, replace=False) for _ in range(m)])  # two are never used
    first = np.concatenate([6 * np.arange(points), 6 * points + np.arange(edges + 1)])
    entities, matrices = np.concatenate([of_points, of_edges], axis=1), rng.normal(size=(m, 21, 21))
    local, within = numbered(entities, first)
    dofs = first[entities][:, local] + within
    rows, columns = np.broadcast_arrays(dofs[:, :, None], dofs[:, None, :])
    expected = coo_matrix((matrices.ravel(), (rows.ravel(), columns.ravel())), shape=(first[-1],) * 2).toarray()
    whole = sum_up(matrices, entities, first)
    assert np.abs(whole.toarray() - expected).max() < 1e-13
    assert whole.has_canonical_format or whole.has_sorted_indices
    monkeypatch.setattr("fem_plate.elements.assembly.CHUNK", 7)
    assert np.abs(sum_up(matrices, entities, first).toarray() - expected).max() < 1e-13


@pytest.fixture(scope="module")
def crooked():
    """A free rectangle of crooked cells: its matrices are those of the triangles alone."""
    mesh = rectangle(2.0, 1.4, 0.7)
    points, rim = mesh.points.copy(), np.unique(np.concatenate(list(mesh.boundaries.values())))
    inner = np.setdiff1d(np.arange(len(points)), rim)
    points[inner] += np.random.default_rng(1).uniform(-0.12, 0.12, (len(inner), 2))
    return PlateMesh(points, mesh.triangles, mesh.boundaries, {}, mesh.outline)


def from_stock(space, mesh):
    """scikit-fem's basis on the same mesh, and the matrix that gives its unknowns from ours."""
    grid = MeshTri(mesh.points.T / mesh.size, np.sort(mesh.triangles, axis=1).T)
    basis = Basis(grid, ElementTriArgyris(), intorder=10)
    n = len(mesh.points)
    ends = mesh.triangles[:, EDGES]  # (m, 3, 2)
    ours = {tuple(sorted(e)): u for e, u in zip(ends.reshape(-1, 2).tolist(), space.dofs[:, 18:].ravel(), strict=True)}
    rows, columns, data = [basis.nodal_dofs.T.ravel()], [np.arange(6 * n)], [np.ones(6 * n)]
    for facet, (a, b) in enumerate(grid.facets.T.tolist()):
        along = grid.p[:, b] - grid.p[:, a]
        # Theirs points from the higher to the lower point turned right, but outwards on the rim.
        sign = -1.0
        if grid.f2t[1, facet] < 0:
            outward = grid.p[:, a] - grid.p[:, grid.t[:, grid.f2t[0, facet]]].mean(axis=1)
            sign = np.sign(along[1] * outward[0] - along[0] * outward[1])
        rows.append(basis.facet_dofs[0, [facet]])
        columns.append(np.array([ours[min(a, b), max(a, b)]]))
        data.append(np.array([sign]))
    flat = [np.concatenate(parts) for parts in (data, rows, columns)]
    return basis, coo_matrix((flat[0], (flat[1], flat[2]))).tocsr()


def bending_form(nu):
    @BilinearForm
    def form(u, v, _):
        hu, hv = dd(u), dd(v)
        return (1 - nu) * ddot(hu, hv) + nu * trace(hu) * trace(hv)

    return form


@BilinearForm
def mass_form(u, v, _):
    return u * v


@pytest.mark.parametrize("which", ["mass", 0.0, 0.3, 0.45])
def test_matrices_are_those_of_the_stock_element_entry_by_entry(crooked, which):
    space = PlateSpace(crooked, dict.fromkeys(crooked.boundaries, "free"))
    ours = space.mass() if which == "mass" else space.stiffness(bending_law(which))
    basis, change = from_stock(space, crooked)
    stock = (mass_form if which == "mass" else bending_form(which)).assemble(basis)
    expected = (change.T @ stock @ change).toarray()
    scale = 1 / np.sqrt(np.diag(expected))
    assert np.abs((ours.toarray() - expected) * scale * scale[:, None]).max() < 1e-10


@pytest.mark.parametrize("nu", [0.0, 0.3])
def test_rigid_motions_do_not_bend(nu):
    for mesh in (disc(1.0, 0.4), annulus(0.3, 1.0, 0.5), polygon([(0, 0), (1, 0), (1, 1), (0.3, 0.4)], 0.4)):
        space = PlateSpace(mesh, dict.fromkeys(mesh.boundaries, "free"))
        matrix, rigid = space.stiffness(bending_law(nu)), space.linear()
        assert np.abs(rigid.T @ matrix @ rigid).max() < 1e-10
        scale = 1 / np.sqrt(matrix.diagonal())
        values = np.linalg.eigvalsh((matrix.toarray() * scale) * scale[:, None])
        assert np.abs(values[:3]).max() < 1e-12 and values[3] > 1e-7


def moments(a, b):
    """The integrals of 1, x^2 and x^4 y^2 over an ellipse, in units of 2 m."""
    return np.pi * np.array([a * b, a**3 * b / 4, a**5 * b**3 / 64])


CURVED = {
    "disc": (disc(2.0, 0.8), moments(1, 1)),
    "ellipse": (ellipse(2.0, 1.0, 0.6), moments(1, 0.5)),
    "upright ellipse": (ellipse(0.5, 2.0, 0.6), moments(0.25, 1)),
    "annulus": (annulus(0.8, 2.0, 0.8), moments(1, 1) - moments(0.4, 0.4)),
}


@pytest.mark.parametrize("shape", CURVED)
def test_quadrature_reaches_to_the_true_rim(shape):
    mesh, expected = CURVED[shape]
    space = PlateSpace(mesh, dict.fromkeys(mesh.boundaries, "clamped"))
    points, weights = space.quadrature
    x, y = points.T
    found = np.array([weights.sum(), weights @ x**2, weights @ (x**4 * y**2)]) * (mesh.size / 2) ** np.array([2, 4, 8])
    assert np.abs(found / expected - 1).max() < 1e-14


@pytest.mark.parametrize("shape", CURVED)
def test_mass_reaches_to_the_true_rim(shape):
    mesh, expected = CURVED[shape]
    space = PlateSpace(mesh, dict.fromkeys(mesh.boundaries, "clamped"))
    one, x, _ = space.linear().T
    x2y = unknowns_of_x2y(space)
    mass = space.mass()
    found = np.array([u @ (mass @ u) for u in (one, x, x2y)]) * (mesh.size / 2) ** np.array([2, 4, 8])
    assert np.abs(found / expected - 1).max() < 1e-13


def unknowns_of_x2y(space):
    values = {
        (0, 0): lambda x, y: x**2 * y,
        (1, 0): lambda x, y: 2 * x * y,
        (0, 1): lambda x, y: x**2,
        (2, 0): lambda x, y: 2 * y,
        (1, 1): lambda x, y: 2 * x,
        (0, 2): lambda x, y: 0 * x,
    }
    triangles, u = space.triangles, np.full(space.unknowns, np.nan)
    x, y = np.moveaxis(triangles.points, 2, 0)
    corners = [values[d](x, y) for order in range(3) for d in DERIVATIVES[order]]
    u[space.dofs[:, :18].reshape(-1, 3, 6)] = np.stack(corners, axis=2)
    middle = triangles.points[:, EDGES].mean(axis=2)
    x, y = np.moveaxis(middle, 2, 0)
    u[space.dofs[:, 18:]] = 2 * x * y * triangles.normals[..., 0] + x**2 * triangles.normals[..., 1]
    return u


def test_the_stiffness_of_a_held_plate_is_symmetric_and_positive_definite():
    for kind in ("clamped", "simply-supported"):
        for mesh in (disc(1.0, 1 / 2), rectangle(1.0, 2.0, 0.5), ellipse(1.0, 0.3, 0.2)):
            matrix = PlateSpace(mesh, dict.fromkeys(mesh.boundaries, kind)).stiffness(bending_law(0.3)).toarray()
            scale = 1 / np.sqrt(np.diag(matrix))
            matrix = matrix * scale * scale[:, None]
            assert np.abs(matrix - matrix.T).max() < 1e-14
            assert np.linalg.eigvalsh(matrix)[0] > 1e-7
