"""A rough contact whose law holds point by point under a part with a size, on a surface that bends under it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from particle.checks import positive, refuse
from particle.footprint import Footprint
from particle.friction.contact import LOCAL, FrictionLaw, friction_limits
from particle.friction.face import LEAST as TABLE_BEGIN
from particle.friction.face import STRETCH as TABLE_STRETCH
from particle.friction.face import FaceLaw, per_area
from particle.friction.grip import FAR_STEPS, LEAST, NEAR, SIDES, STEPS, grips
from particle.friction.kogut_etsion import KogutEtsion
from particle.types import FloatArray


@dataclass(frozen=True)
class LocalContact:
    """Kogut and Etsion's contact under a part with a size, point by point, by the surface's curvature under it.

    Parameters
    ----------
    contact : KogutEtsion
        The law of the surfaces; the area is that of the face, whatever its own.
    size : float or Footprint
        Side of the square under a part that does not turn, along x and y, m; or the footprint of a `Body`.

    Raises
    ------
    ValueError
        The side is not positive, or part of a footprint is hidden from its centroid behind another.
    """

    contact: KogutEtsion
    size: float | Footprint  # m

    def __post_init__(self) -> None:
        if isinstance(self.size, Footprint):
            seen, corners = self.size.star_shaped, self.size.corners.tolist()
            refuse("LocalContact", [(seen, "size", "a footprint all of which its centroid sees", corners)])
        else:
            refuse("LocalContact", [(positive(self.size), "size", "a positive length in m", self.size)])

    @cached_property
    def footprint(self) -> Footprint:
        """The face."""
        return self.size if isinstance(self.size, Footprint) else Footprint.rectangle(self.size, self.size)

    @cached_property
    def flat(self) -> KogutEtsion:
        """The contact on a flat surface."""
        return replace(self.contact, contact_area=self.footprint.area)

    @property
    def pull_off(self) -> float:
        """N, on a flat surface."""
        return self.flat.pull_off

    @property
    def largest_load(self) -> float:
        """N, on a flat surface."""
        return self.flat.largest_load

    @property
    def table_error(self) -> float:
        """Relative error of the tabulated limit on a flat surface."""
        return self.flat.table_error

    def friction_limit(self, net_load: ArrayLike) -> FloatArray:
        """Q [N] on a flat surface under net loads [N] of any shape; ValueError for one outside the law."""
        return friction_limits(self.law, net_load)

    def on_surface(self, hessian: ArrayLike) -> FaceLaw:
        """The contact on a surface with the second derivatives (2, 2) [1/m], by finer rules than a path's."""
        return FaceLaw(self.contact, self.footprint, hessian)

    def bears(self, net_load: ArrayLike, hessian: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Of a square: friction limit and pull-off force (k,) [N] under loads (k,) [N] on surfaces (k, 2, 2) [1/m]."""
        loads = np.asarray(net_load, dtype=float)
        bends = np.asarray(hessian, dtype=float).reshape(-1, 4)[:, [0, 1, 3]]
        limits, flat = grips(self.law, loads, np.ascontiguousarray(bends))
        return limits, flat + self.pull_off - loads

    @cached_property
    def law(self) -> FrictionLaw:
        """The flat contact's table, with p - a and q per area and the points of the face."""
        turns = isinstance(self.size, Footprint)
        rules = [_of_face(self.footprint, n) if turns else _half_square(n, self.footprint) for n in SIDES]
        x, y = np.abs(self.footprint.corners).max(axis=0, initial=self.footprint.radius)
        corner = np.array([[x * x / 2, x * y, y * y / 2, *np.zeros(rules[0].shape[1] - 3)]])
        places = np.concatenate([*rules, corner])
        places[:, :3] /= self.contact.roughness
        return self.flat.law._replace(
            kind=LOCAL,
            roughness=self.contact.roughness,
            fold=self.contact.branch[1],
            per_area=_per_area(self.contact),
            places=places,
            ends=np.cumsum([len(rule) for rule in rules]),
        )


def _half_square(count: int, square: Footprint) -> FloatArray:
    """x^2/2, x y and y^2/2 at Gauss's points of the upper half of a square, and twice their weights; (n, 4) [m^2]."""
    side = 2 * float(square.corners.max())
    x, w_x = np.polynomial.legendre.leggauss(count)
    y, w_y = np.polynomial.legendre.leggauss(count // 2)
    x, y = (each.ravel() * side / 2 for each in np.meshgrid(x, (y + 1) / 2, indexing="ij"))
    return np.column_stack([x * x / 2, x * y, y * y / 2, np.outer(w_x, w_y).ravel() * side**2 / 4])


def _of_face(footprint: Footprint, count: int) -> FloatArray:
    """x^2/2, x y and y^2/2 [m^2] at points of a face, their weights [m^2], and x and y over its reach; (n, 6)."""
    (x, y), weights = footprint.even_rule(count)[0].T, footprint.even_rule(count)[1] * footprint.area
    return np.column_stack([x * x / 2, x * y, y * y / 2, weights, x / footprint.reach, y / footprint.reach])


def _per_area(contact: KogutEtsion) -> FloatArray:
    """Cubics of p - a and q [Pa] over the separation up to NEAR, then of (p - a) d^2 over 1/d; (intervals, 8)."""
    from scipy.interpolate import CubicSpline  # here, because other laws do without it

    def pressures(d: FloatArray) -> FloatArray:
        return np.asarray(per_area(contact)(np.log1p((d - TABLE_BEGIN) / TABLE_STRETCH)))

    near = np.linspace(LEAST, NEAR, round((NEAR - LEAST) * STEPS) + 1)
    over = np.linspace(0.0, 1 / NEAR, FAR_STEPS + 1)
    far = 1 / np.maximum(over, 1e-6)
    tables = CubicSpline(near, pressures(near)), CubicSpline(over, pressures(far) * far[:, None] ** 2)
    return np.concatenate([table.c.transpose(1, 2, 0).reshape(-1, 8) for table in tables])
