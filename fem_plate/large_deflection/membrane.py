"""Membrane: what stretching adds to a plate's energy, in one of two discretisations.

Dimensionless: lengths by the plate's size a, w by the thickness t, membrane forces by D / a^2, in-plane motion by
t^2 / a, energies by D t^2 / a^2. With p = grad w, pp = p p^T and m the membrane's unknowns, whose force is L m,

    energy = sign 1/2 m.S m + 1/2 int (L m) : pp + 1/8 int pp : A : pp

The Airy function has sign -1 and no A; in-plane motion has +1 and the plate's membrane law A. At rest the energy is
stationary in m: m = -sign S^-1 t with t = 1/2 int L : pp.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_matrix
from skfem.quadrature import get_quadrature
from skfem.refdom import RefTri

from fem_plate.elements import CLAMPED, FREE, PlateModel, PlateSpace, SingularCorner, factorised, singular_corners
from fem_plate.sections import bending_law
from fem_plate.types import FloatArray, IntArray
from meshes import PlateMesh

AIRY, PLANE_STRESS = "airy", "plane-stress"


@dataclass(frozen=True, eq=False)
class Membrane:
    """One discretisation of a plate's stretching."""

    name: str  # "airy" or "plane-stress"
    samples: tuple[Samples, ...]
    dofs: IntArray  # (triangles, m), all unknowns of each triangle
    stiffness: csc_matrix  # S, of the independent ones
    solve: Callable[[FloatArray], FloatArray]  # S^-1
    sign: float
    law: FloatArray | None  # A (3, 3), from strains (xx, 2 xy, yy) to forces (xx, xy, yy); None: there is none
    expand: Callable[[FloatArray], FloatArray]  # all unknowns from the independent ones
    reduce: Callable[[FloatArray], FloatArray]  # its transpose

    def respond(self, slopes: list[FloatArray]) -> tuple[FloatArray, float]:
        """The unknowns at rest and the energy, for slopes p (k, 2 n) at each set of samples."""
        t = np.zeros(int(self.dofs.max()) + 1)
        beyond = 0.0
        for samples, p in zip(self.samples, slopes, strict=True):
            square = squares(p)
            element = np.einsum("kni,kn->ki", samples.operator, samples.weighted(0.5 * square), optimize=True)
            np.add.at(t, self.dofs[samples.triangle], element)
            if self.law is not None:
                beyond += 0.125 * float((samples.weighted(square) * self.by_law(square)).sum())
        t = self.reduce(t)
        m = -self.sign * self.solve(t)
        return m, 0.5 * float(m @ t) + beyond

    def linear_force(self, samples: Samples, everything: FloatArray) -> FloatArray:
        """The membrane force (k, 3 n, c) of all unknowns (all, c)."""
        return np.asarray(samples.operator @ everything[self.dofs[samples.triangle]])

    def force(self, samples: Samples, everything: FloatArray, p: FloatArray) -> FloatArray:
        """The membrane force (k, 3 n), from all unknowns and the plate's slopes p (k, 2 n)."""
        force = self.linear_force(samples, everything[:, None])[..., 0]
        return np.asarray(force if self.law is None else force + 0.5 * self.by_law(squares(p)))

    def stiffening(self, p: FloatArray) -> FloatArray:
        """What adds to the force in the energy's second derivative: B (k, 3 n) with q.B q = (p q) : A : (p q)."""
        if self.law is None:
            return np.zeros((len(p), 3 * p.shape[1] // 2))
        (x, y), A = halves(p), self.law
        xx = A[0, 0] * x * x + 2 * A[0, 1] * x * y + A[1, 1] * y * y
        xy = A[0, 1] * x * x + (A[0, 2] + A[1, 1]) * x * y + A[1, 2] * y * y
        yy = A[1, 1] * x * x + 2 * A[1, 2] * x * y + A[2, 2] * y * y
        return np.concatenate([xx, xy, yy], axis=1)

    def by_law(self, strain: FloatArray) -> FloatArray:
        """A times stacked strains (k, 3 n, ...)."""
        assert self.law is not None
        return np.concatenate(
            [sum(a * part for a, part in zip(row, thirds(strain), strict=True)) for row in self.law], axis=1
        )


@dataclass(frozen=True, eq=False)
class Samples:
    """n points on each of k triangles.

    Arrays are stacked: slopes (k, 2 n) hold x at all points, then y; tensors (k, 3 n) hold xx, then xy, then yy.
    """

    triangle: IntArray  # (k,)
    points: FloatArray  # (k, n, 2)
    weights: FloatArray  # (k, n)
    gradient: FloatArray  # (k, 2 n, 21), slopes of the plate's functions
    operator: FloatArray  # (k, 3 n, m), membrane forces of the membrane's functions

    @staticmethod
    def at(
        space: PlateSpace, triangle: IntArray, points: FloatArray, weights: FloatArray, operator: FloatArray
    ) -> Samples:
        """Samples at points of triangles (k,)."""
        x, y = space.triangles.derivatives(points, triangle, 1)
        return Samples(triangle, points, weights, np.concatenate([x, y], axis=1), operator)

    def weighted(self, stacked: FloatArray) -> FloatArray:
        """Stacked quantities (k, j n, ...) times the weights."""
        whole = np.tile(self.weights, stacked.shape[1] // self.weights.shape[1])
        return stacked * whole.reshape(*whole.shape, *[1] * (stacked.ndim - 2))


def halves(slopes: FloatArray) -> tuple[FloatArray, FloatArray]:
    """x and y of stacked slopes (k, 2 n, ...)."""
    n = slopes.shape[1] // 2
    return slopes[:, :n], slopes[:, n:]


def thirds(tensor: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """xx, xy and yy of stacked tensors (k, 3 n, ...)."""
    n = tensor.shape[1] // 3
    return tensor[:, :n], tensor[:, n : 2 * n], tensor[:, 2 * n :]


def times(tensor: FloatArray, slopes: FloatArray) -> FloatArray:
    """Tensors (k, 3 n) times slopes (k, 2 n, c): (k, 2 n, c)."""
    xx, xy, yy = thirds(tensor[..., None])
    x, y = halves(slopes)
    return np.concatenate([xx * x + xy * y, xy * x + yy * y], axis=1)


def strains(p: FloatArray, slopes: FloatArray) -> FloatArray:
    """p (k, 2 n) with slopes q (k, 2 n, c) as strains (p_x q_x, p_x q_y + p_y q_x, p_y q_y): (k, 3 n, c)."""
    (p_x, p_y), (x, y) = halves(p[..., None]), halves(slopes)
    return np.concatenate([p_x * x, p_x * y + p_y * x, p_y * y], axis=1)


def squares(p: FloatArray) -> FloatArray:
    """p with itself, (k, 3 n)."""
    return strains(p, p[..., None])[..., 0]


DEGREE = 12  # of the quadrature: forces have degree 3, slopes 4 each


def airy_corners(mesh: PlateMesh, movable: bool, poisson_ratio: float) -> list[SingularCorner]:
    """The corners where the stress function is not smooth."""
    return singular_corners(mesh, _supports(mesh, movable), -poisson_ratio)


def airy(mesh: PlateMesh, movable: bool, poisson_ratio: float, corners: Sequence[int]) -> Membrane:
    """The membrane by Airy's stress function F: force xx = F_yy, yy = F_xx, xy = -F_xy.

    Its energy 1/(2 E t) int (laplace F)^2 - (1 + nu) [F, F] is that of a plate of Poisson's ratio -nu, free where the
    rim is immovable and clamped where it can move. It bounds the membrane energy from below. The plate has no holes,
    and its whole rim is immovable, or free to move, in its plane.

    corners: rows of mesh points where second derivatives may jump.
    """
    model = PlateModel(mesh, _supports(mesh, movable), bending_law(-poisson_ratio), corners)
    space = model.space
    stiffness = (model.pinned_stiffness / (12 * (1 - poisson_ratio**2))).tocsc()
    xy, weights = get_quadrature(RefTri, DEGREE)
    triangles = space.triangles
    inside = triangles.points[:, 0, None] + np.einsum("mij,jn->mni", triangles.jacobian, xy)
    every = np.arange(len(inside))
    samples = [_samples(space, every, inside, triangles.determinant[:, None] * weights)]
    if len(space.slivers.triangle):
        samples.append(_samples(space, *space.slivers))
    return Membrane(
        name=AIRY,
        samples=tuple(samples),
        dofs=space.dofs,
        stiffness=stiffness,
        solve=factorised(stiffness),
        sign=-1.0,
        law=None,
        expand=space.element_dofs,
        reduce=space.to_independent,
    )


def _supports(mesh: PlateMesh, movable: bool) -> dict[str, str]:
    """Those of the plate that the stress function is the deflection of."""
    return dict.fromkeys(mesh.boundaries, CLAMPED if movable else FREE)


def _samples(space: PlateSpace, triangle: IntArray, points: FloatArray, weights: FloatArray) -> Samples:
    xx, xy, yy = space.triangles.derivatives(points, triangle, 2)
    return Samples.at(space, triangle, points, weights, np.concatenate([yy, -xy, xx], axis=1))
