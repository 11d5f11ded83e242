"""Functions on the plate: a finite-element part plus parts known in closed form."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fem_plate.elements.infinite import PLAIN, InfinitePlate
from fem_plate.elements.space import PlateSpace
from fem_plate.types import FloatArray

Derivatives = tuple[FloatArray, FloatArray, FloatArray]  # value, gradient, Hessian


@dataclass(frozen=True, eq=False)
class PlateFunctions:
    """k functions w = v + sum_j forces_j F(x - sources_j) + pressure Q(r) + rigid . (1, x, y), dimensionless.

    F and Q are the infinite plate's responses; r is the distance from the middle of the plate's box.
    """

    space: PlateSpace
    unknowns: FloatArray  # (unknowns, k), of v
    sources: FloatArray  # (N, 2)
    forces: FloatArray  # (N, k)
    rigid: FloatArray  # (3, k)
    pressure: FloatArray  # (k,)
    infinite: InfinitePlate = PLAIN

    def weighted(self, weights: FloatArray) -> PlateFunctions:
        """The sum of the functions times weights (k,) or (k, m)."""
        weights = weights.reshape(len(weights), -1)
        return replace(
            self,
            unknowns=self.unknowns @ weights,
            forces=self.forces @ weights,
            rigid=self.rigid @ weights,
            pressure=self.pressure @ weights,
        )

    def beside(self, others: PlateFunctions) -> PlateFunctions:
        """The functions, then others of the same sources on the same cells."""
        return replace(
            self,
            unknowns=np.concatenate([self.unknowns, others.unknowns], axis=1),
            forces=np.concatenate([self.forces, others.forces], axis=1),
            rigid=np.concatenate([self.rigid, others.rigid], axis=1),
            pressure=np.concatenate([self.pressure, others.pressure]),
        )

    def raised(self, unknowns: FloatArray) -> PlateFunctions:
        """The functions with more of finite elements, (unknowns, k)."""
        return replace(self, unknowns=self.unknowns + unknowns)

    def values(self, x: FloatArray) -> FloatArray:
        """The functions' values alone, (n, k)."""
        (value,) = self.space.evaluate(x, self.unknowns, orders=1)
        value += np.column_stack([np.ones(len(x)), x]) @ self.rigid
        if np.any(self.pressure):
            value += np.outer(self.infinite.pressure_derivatives(x - self.space.middle)[0][0], self.pressure)
        return value + self.infinite.point_value(x, self.sources) @ self.forces

    def laplacians(self, x: FloatArray, floor: float) -> FloatArray:
        """The functions' Laplacians, (n, k), bounded within the radius `floor` of each source."""
        laplacian = self.space.laplacians(x, self.unknowns)
        laplacian = laplacian + self.infinite.point_laplacian(x, self.sources, floor) @ self.forces
        if np.any(self.pressure):
            xx, _, yy = self.infinite.pressure_derivatives(x - self.space.middle)[2]
            laplacian += np.outer(xx + yy, self.pressure)
        return laplacian

    def smooth(self, x: FloatArray) -> Derivatives:
        """All but the forces' part at points (n, 2): value (n, k), gradient (n, k, 2), Hessian (n, k, 2, 2)."""
        value, gradient, hessian = self.space.evaluate(x, self.unknowns, orders=3)
        value += np.column_stack([np.ones(len(x)), x]) @ self.rigid
        gradient += self.rigid[1:].T
        if np.any(self.pressure):
            (w,), w_grad, (w_xx, w_xy, w_yy), _ = self.infinite.pressure_derivatives(x - self.space.middle)
            w_hess = np.stack([np.stack([w_xx, w_xy], -1), np.stack([w_xy, w_yy], -1)], -1)
            value += np.outer(w, self.pressure)
            gradient += w_grad.T[:, None] * self.pressure[:, None]
            hessian += w_hess[:, None] * self.pressure[:, None, None]
        return value, gradient, hessian

    def known_slopes(self, x: FloatArray) -> FloatArray:
        """The slopes (n, 2, k) of all but the finite elements at points (n, 2)."""
        slopes = np.einsum("njd,jk->ndk", self.infinite.point_load(x, self.sources)[1], self.forces, optimize=True)
        slopes += self.rigid[1:]
        if np.any(self.pressure):
            slopes += self.infinite.pressure_derivatives(x - self.space.middle)[1].T[:, :, None] * self.pressure
        return np.asarray(slopes)

    def evaluate(self, x: FloatArray) -> Derivatives:
        """The functions at points (n, 2); at a source the Hessian is infinite."""
        value, gradient, hessian = self.smooth(x)
        F, F_grad, F_hess = self.infinite.point_load(x, self.sources)
        with np.errstate(invalid="ignore"):  # inf - inf and 0 inf at sources
            return (
                value + F @ self.forces,
                gradient + np.einsum("njd,jk->nkd", F_grad, self.forces, optimize=True),
                hessian + np.einsum("njde,jk->nkde", F_hess, self.forces, optimize=True),
            )
