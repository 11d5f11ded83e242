"""Kogut and Etsion's contact on the face of a part that stands on a curved surface: the law, point by point.

The law is local: where surfaces are d roughnesses apart they press with p(d), attract with a(d) and carry at most q(d)
per area. Over a surface whose second derivatives are H the gap under a flat face at the height z and with the tilt g is

    d(r) sigma = z + g.r - r.H r/2,      N = int (p - a) dA,     Q = int q dA,

and z and g follow from the load N and from moments int (p - a) r dA of 0 about the centroid. The pull-off force is
minus the least N over z. Friction resists a turn about the centroid by up to int q |r| dA.
"""

from __future__ import annotations

import math
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, Protocol

import numpy as np
from numpy.typing import ArrayLike

from particle.footprint import Footprint
from particle.friction.contact import check_loads
from particle.friction.quadrature import lowest
from particle.types import FloatArray

if TYPE_CHECKING:
    from scipy.interpolate import CubicSpline

POINTS = 48  # from the face's centroid outwards, and along each side
KNOTS = 16384
LEAST, STRETCH = -4.0, 2.0  # roughnesses: where the table begins; it is uniform in ln(1 + (d - LEAST)/STRETCH)
FAR, FARTHEST = 40.0, 1e6  # roughnesses, from where on no asperity touches, and where the table ends
HIGHEST, HEIGHTS = 8.0, 161  # roughnesses, of the face over the highest point below it
TURNS, SETTLED, LONGEST = 200, 1e-13, 0.25  # Newton steps of the tilt, in roughnesses at the farthest point


class SeparationLaw(Protocol):
    """A law of surfaces at a separation, for a nominal area."""

    @property
    def roughness(self) -> float: ...

    @property
    def contact_area(self) -> float: ...

    def __hash__(self) -> int: ...

    def forces(self, separation: ArrayLike) -> tuple[FloatArray, FloatArray, FloatArray]: ...

    def far_adhesion(self, separation: ArrayLike) -> FloatArray: ...


@lru_cache(maxsize=16)
def per_area(contact: SeparationLaw) -> CubicSpline:
    """p - a and q [Pa] of a contact, two columns, over ln(1 + (d - LEAST)/STRETCH)."""
    from scipy.interpolate import CubicSpline  # here, because other laws do without it

    stretched = np.linspace(0, math.log1p((FARTHEST - LEAST) / STRETCH), KNOTS + 1)
    d = LEAST + STRETCH * np.expm1(stretched)
    near = d < FAR
    load, adhesion, limit = np.zeros((3, len(d)))
    load[near], adhesion[near], limit[near] = contact.forces(d[near])
    adhesion[~near] = contact.far_adhesion(d[~near])
    return CubicSpline(stretched, np.column_stack([load - adhesion, limit]) / contact.contact_area)


class FaceLaw:
    """The contact of a flat face with a surface of constant curvature; made by `KogutEtsion.on_face`."""

    def __init__(self, contact: SeparationLaw, footprint: Footprint, hessian: ArrayLike) -> None:
        bend = np.array(hessian, dtype=float)
        rounding = 1e-9 * np.abs(bend).max(initial=0.0)  # of one that was turned into the face's axes
        if bend.shape != (2, 2) or not np.isfinite(bend).all() or abs(bend[0, 1] - bend[1, 0]) > rounding:
            raise ValueError(f"Input hessian of on_face must be a symmetric 2 x 2 matrix in 1/m; got {hessian!r}")
        self.contact, self.footprint, self.hessian = contact, footprint, bend
        self._places, weights = footprint.rule(POINTS)
        self._weights = weights * footprint.area
        heights = np.einsum("ki,ij,kj->k", self._places, bend, self._places) / 2
        self._sag = (heights.max() - heights) / contact.roughness
        self._arms = self._places / footprint.reach

    def _pressures(self, height: float) -> tuple[FloatArray, FloatArray]:
        """p - a and q [Pa], (n,) each, under a face without moments, `height` roughnesses over the highest point."""
        spline, tilt = per_area(self.contact), np.zeros(2)
        for _ in range(TURNS):
            above = height + self._sag + self._arms @ tilt - LEAST
            place = np.log1p(above / STRETCH)
            slopes = self._weights * spline(place, 1)[:, 0] / (STRETCH + above)
            moments = self._arms.T @ (self._weights * spline(place)[:, 0])
            step = np.linalg.solve((self._arms.T * slopes) @ self._arms, -moments)
            longest = float(np.abs(step).max())
            tilt += step * min(1.0, LONGEST / max(longest, LONGEST))
            if longest < SETTLED:
                break
        net, limit = spline(np.log1p((height + self._sag + self._arms @ tilt - LEAST) / STRETCH)).T
        return net, limit

    def _sums(self, heights: ArrayLike) -> tuple[FloatArray, FloatArray, FloatArray]:
        """N [N], Q [N] and the torque limit [N m] at heights (n,)."""
        sums = []
        for height in np.asarray(heights, dtype=float).tolist():
            net, limit = self._pressures(height)
            weighed = self._weights * limit
            sums.append((self._weights @ net, weighed.sum(), weighed @ np.hypot(*self._places.T)))
        net_loads, limits, torques = np.reshape(sums, (-1, 3)).T
        return net_loads, limits, torques

    @cached_property
    def _branch(self) -> tuple[float, float]:
        """The heights [roughnesses] between which friction grows with the load: the peak of Q, or 0, and pull-off."""
        grid = np.linspace(0.0, HIGHEST, HEIGHTS)
        net, limit, _ = self._sums(grid)
        least, peak = int(np.argmin(net)), int(np.argmax(limit))
        if not (peak < least < HEIGHTS - 1 and net[least] < 0):
            raise ValueError("Inputs of KogutEtsion must give a face a pull-off force; these do not")
        top = lowest(lambda z: -self._sums(z)[1], grid[max(peak - 1, 0)], grid[peak + 1])
        return top, lowest(lambda z: self._sums(z)[0], grid[least - 1], grid[least + 1])

    @cached_property
    def pull_off(self) -> float:
        """The force [N] that pulls the face off, positive."""
        return -float(self._sums([self._branch[1]])[0][0])

    @cached_property
    def largest_load(self) -> float:
        """The net load [N] where Q peaks, or where the gap closes if it has not by then; the law ends there."""
        return float(self._sums([self._branch[0]])[0][0])

    def _heights(self, net_load: ArrayLike) -> FloatArray:
        from scipy.optimize import brentq  # here, because no run needs it

        loads = np.asarray(net_load, dtype=float)
        check_loads(loads, self.pull_off, self.largest_load)
        low, high = self._branch
        ends = {self.largest_load: low, -self.pull_off: high}

        def excess(height: float, load: float) -> float:
            return float(self._sums([height])[0][0]) - load

        return np.array(
            [
                ends[load] if load in ends else brentq(excess, low, high, args=(load,), xtol=1e-13, rtol=1e-14)
                for load in loads.ravel().tolist()
            ]
        )

    def friction_limit(self, net_load: ArrayLike) -> FloatArray:
        """Q [N] under net loads [N] of any shape; ValueError for one outside the law."""
        return np.reshape(self._sums(self._heights(net_load))[1], np.shape(net_load))

    def torque_limit(self, net_load: ArrayLike) -> FloatArray:
        """The largest friction torque [N m] about the centroid under net loads [N] of any shape; as friction_limit."""
        return np.reshape(self._sums(self._heights(net_load))[2], np.shape(net_load))
