"""The discrete plate: Argyris space, quadrature up to the true rim, stiffness matrix and point evaluation."""

from __future__ import annotations

from functools import cached_property
from types import SimpleNamespace

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix, csc_matrix
from scipy.spatial import cKDTree
from skfem import CellBasis, DiscreteField, MeshTri

from fem_plate import forms
from fem_plate.argyris import ArgyrisBasis, ElementArgyris
from meshes import PlateMesh

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

# A rim triangle's integrands are polynomials along a curve: this many points a side leave rounding errors only.
RIM_POINTS = 8
CHUNK = 20_000  # points evaluated at once, to bound memory


class PlateSpace:
    """Argyris functions on a mesh whose lengths are divided by the plate's size."""

    def __init__(self, mesh: PlateMesh) -> None:
        self.grid = MeshTri(np.ascontiguousarray(mesh.points.T) / mesh.size, np.ascontiguousarray(mesh.triangles.T))
        self.polynomials = ArgyrisBasis(self.grid)
        self._rim = _rim_edges(mesh)
        inner = np.setdiff1d(np.arange(self.grid.nelements), self._rim.triangle)
        element = ElementArgyris(self.polynomials)
        self.inner = CellBasis(self.grid, element, intorder=6, elements=inner, disable_doflocs=True)

    @property
    def unknowns(self) -> int:
        return int(self.inner.N)

    def stiffness(self, poisson_ratio: float) -> csc_matrix:
        """The symmetric positive definite matrix of the clamped plate."""
        bending = forms.bending(poisson_ratio)
        rim, extra = self.rim
        parts = [bending.assemble(self.inner), bending.assemble(self.curved)]
        return sum(parts, start=forms.clamped_rim(poisson_ratio).assemble(rim, **extra)).tocsc()

    def mass(self) -> csc_matrix:
        """The matrix of int v q."""
        element = ElementArgyris(self.polynomials, derivatives=1)
        inner = CellBasis(
            self.grid, element, intorder=10, elements=self.inner.tind, dofs=self.inner.dofs, disable_doflocs=True
        )
        return (forms.mass.assemble(inner) + forms.mass.assemble(self.curved)).tocsc()

    def point_values(self, xy: FloatArray) -> csc_matrix:
        """The matrix (n, unknowns) whose product with a function's unknowns is its value at points (n, 2)."""
        triangle = self._locate(xy)
        data = self.polynomials.evaluate(xy[:, None], triangle, 0)[0, :, 0]
        columns = self.inner.dofs.element_dofs[:, triangle].T
        rows = np.broadcast_to(np.arange(len(xy))[:, None], columns.shape)
        return coo_matrix((data.ravel(), (rows.ravel(), columns.ravel())), shape=(len(xy), self.unknowns)).tocsc()

    def rim_operator(self, poisson_ratio: float) -> csc_matrix:
        """The matrix (unknowns, 3 points) that turns g, g_x, g_y at the rim's quadrature points into a right side."""
        rim, extra = self.rim
        columns = np.arange(rim.dx.size).reshape(rim.dx.shape)
        rows, cols, data = [], [], []
        for k, density in enumerate(forms.rim_data(poisson_ratio)):
            for i in range(rim.Nbfun):
                data.append(density(rim.basis[i][0], SimpleNamespace(**extra)) * rim.dx)
                rows.append(np.broadcast_to(rim.element_dofs[i][:, None], columns.shape))
                cols.append(columns + k * columns.size)
        flat = [np.concatenate([part.ravel() for part in parts]) for parts in (data, rows, cols)]
        return coo_matrix((flat[0], (flat[1], flat[2])), shape=(self.unknowns, 3 * columns.size)).tocsc()

    @property
    def rim_points(self) -> FloatArray:
        """The rim's quadrature points, (n, 2)."""
        return self._rim.points.reshape(-1, 2)

    @cached_property
    def curved(self) -> CellBasis:
        """The cells at the rim, integrated up to the true curve: rays from the inner corner, times the curve."""
        edge, (ray, weight) = self._rim, _unit_gauss(RIM_POINTS)
        apex = edge.apex[:, None]
        points = apex[:, None] + ray[:, None, None] * (edge.points - apex)[:, None]  # (k, ray, along, 2)
        fan = _cross(edge.points - apex, edge.tangents)
        weights = (ray * weight)[:, None] * (edge.weights * fan)[:, None]
        flat = points.reshape(len(points), -1, 2)
        return self._cells(flat, np.abs(weights).reshape(len(points), -1), derivatives=2)

    @cached_property
    def rim(self) -> tuple[CellBasis, dict[str, DiscreteField]]:
        """The rim itself with its outward normals `n` and its edge lengths `edge`."""
        edge = self._rim
        speed = np.linalg.norm(edge.tangents, axis=-1)
        length = edge.weights * speed
        normal = np.stack([edge.tangents[..., 1], -edge.tangents[..., 0]], axis=0) / speed
        h = np.broadcast_to(length.sum(axis=1, keepdims=True), length.shape)
        return self._cells(edge.points, length, derivatives=3), {"n": DiscreteField(normal), "edge": DiscreteField(h)}

    def _cells(self, points: FloatArray, weights: FloatArray, derivatives: int) -> CellBasis:
        """A scikit-fem basis on the rim's triangles with quadrature points (k, n, 2) of their own."""
        triangle, mapping = self._rim.triangle, self.grid.mapping()
        reference = mapping.invF(points.transpose(2, 0, 1), tind=triangle)
        scaled = weights / np.abs(mapping.detDF(reference, tind=triangle))
        element = ElementArgyris(self.polynomials, derivatives)
        return CellBasis(
            self.grid,
            element,
            elements=triangle,
            quadrature=(reference, scaled),
            dofs=self.inner.dofs,
            disable_doflocs=True,
        )

    def evaluate(self, xy: FloatArray, unknowns: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Functions given by their unknowns (unknowns, k) at points (n, 2).

        Returns value (n, k), gradient (n, k, 2), Hessian (n, k, 2, 2). Beyond a rim triangle's chord its polynomial
        goes on, as in the integrals.
        """
        n, k = len(xy), unknowns.shape[1]
        value, gradient, hessian = np.empty((n, k)), np.empty((n, k, 2)), np.empty((n, k, 2, 2))
        for start in range(0, n, CHUNK):
            part = slice(start, start + CHUNK)
            triangle = self._locate(xy[part])
            local = unknowns[self.inner.dofs.element_dofs[:, triangle].T]  # (n, 21, k)
            table = [self.polynomials.evaluate(xy[part, None], triangle, order)[:, :, 0] for order in range(3)]
            values = [np.einsum("dni,nik->dnk", t, local, optimize=True) for t in table]
            value[part] = values[0][0]
            gradient[part] = np.moveaxis(values[1], 0, -1)
            xx, xy_, yy = values[2]
            hessian[part] = np.stack([np.stack([xx, xy_], -1), np.stack([xy_, yy], -1)], -1)
        return value, gradient, hessian

    @cached_property
    def _tree(self) -> cKDTree:
        return cKDTree(self.polynomials.centre)

    def _locate(self, xy: FloatArray) -> IntArray:
        """The triangle that holds each point (n, 2), or the nearest one for a point between a chord and the rim."""
        count = min(12, self.grid.nelements)
        _, candidates = self._tree.query(xy, k=count)
        corners = self.grid.p.T[self.grid.t.T[candidates]]  # (n, count, 3, 2)
        a, b, c = np.moveaxis(corners, 2, 0)
        point = xy[:, None]
        area = _cross(b - a, c - a)
        a, b, c = a - point, b - point, c - point
        # scikit-fem sorts corners by number, so that triangles run either way round: divide by the area first.
        barycentric = np.stack([_cross(b, c), _cross(c, a), _cross(a, b)]) / area
        return np.asarray(candidates[np.arange(len(xy)), np.argmax(barycentric.min(axis=0), axis=1)])


def _rim_edges(mesh: PlateMesh) -> SimpleNamespace:
    """The rim's edges, dimensionless: their triangle, its inner corner, and Gauss points on the true curve.

    triangle (k,), apex (k, 2), points and tangents d/ds (k, n, 2), weights in s (n,).
    """
    s, weights = _unit_gauss(RIM_POINTS)
    edges = np.concatenate(list(mesh.boundaries.values()))
    owner = {tuple(sorted(pair)): t for t, tri in enumerate(mesh.triangles.tolist()) for pair in _pairs(tri)}
    triangle = np.array([owner[tuple(sorted(edge))] for edge in edges.tolist()])
    apex = (mesh.triangles[triangle].sum(axis=1) - edges.sum(axis=1)).astype(np.int64)
    arcs = [mesh.arcs(name, s) for name in mesh.boundaries]
    return SimpleNamespace(
        triangle=triangle,
        apex=mesh.points[apex] / mesh.size,
        points=np.concatenate([points for points, _ in arcs]) / mesh.size,
        tangents=np.concatenate([tangents for _, tangents in arcs]) / mesh.size,
        weights=weights,
    )


def _pairs(triangle: list[int]) -> list[tuple[int, int]]:
    a, b, c = triangle
    return [(a, b), (b, c), (c, a)]


def _unit_gauss(count: int) -> tuple[FloatArray, FloatArray]:
    """Gauss-Legendre points and weights on [0, 1]."""
    x, w = np.polynomial.legendre.leggauss(count)
    return (x + 1) / 2, w / 2


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])
