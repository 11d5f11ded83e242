"""Kogut and Etsion's contact of rough surfaces: load, adhesion and friction limit over separation.

All lengths are divided by the roughness sigma. Asperity heights z follow a Gaussian phi of width s; an asperity higher
than the separation d is pressed by z - d, in units of the critical interference w_c. With

    I^b = ((z - d)/w_c)^b phi dz,      J_c^b = I^b (eps/w_c)^c,      J_nc = (4/3) [(eps/x)^2 - 0.25 (eps/x)^8] phi dz

where x = eps + d - z is the gap of an asperity that does not touch, equations (3)-(5) of the paper are sums of
integrals over ranges of interference. Corrections to their printed form are listed in docs/paper.md.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from particle.footprint import Footprint
from particle.friction.contact import TABLE, FrictionLaw, check_loads, friction_limits, new_law
from particle.friction.face import FaceLaw
from particle.friction.quadrature import from_power, lowest, on_panels
from particle.friction_input import PAPER_PLASTICITY_INDEX, KogutEtsionInput
from particle.types import FloatArray

SAMPLES = 1025  # separations from which the inverse is first found
INTERVALS = (1024, 2048, 4096, 8192)  # of the table: the first that meets MAX_ERROR
MAX_ERROR = 1e-9
ROUNDING = (
    5 * np.finfo(float).eps
)  # of the net load at pull-off, over the adhesion there: measured at random parameters
NEAREST = 1e-9  # pull-offs above pull-off, from where on the table's error is stated
# Brackets of equation (5) beyond the first range: coefficients and powers.
SHEAR = {
    "printed": ((-0.01, 0.09, -0.4, 0.85), 1.0),
    "unrounded": ((-0.007, 0.085, -0.389, 0.822), 1.03),
}
MEAN_PLANE = 0.045944  # of the roughness over beta: how far the mean of the asperities is above that of the surface
SHEAR_POWERS = (4.425, 3.425, 2.425, 1.425)


@dataclass(frozen=True)
class KogutEtsion(KogutEtsionInput):
    """The contact of two rough surfaces under a normal load, equations (3) to (5) of the paper; the defaults are its
    Table 1.

    Parameters
    ----------
    coefficients : str
        `"printed"` as in the paper's equation (5), `"unrounded"` as in the fit behind it.

    Raises
    ------
    ValueError
        A field is wrong; names each.
    """

    @classmethod
    def paper(cls) -> KogutEtsion:
        """A surrogate for the paper's own contact, whose 20.9 m/s^2 do not follow from its Table 1."""
        return cls(plasticity_index=PAPER_PLASTICITY_INDEX)

    @property
    def asperity_width(self) -> float:
        """s = sigma_s / sigma, the width of the asperities' heights over that of the surface's."""
        return math.sqrt(1 - 3.717e-4 / self.asperity_beta**2)

    @property
    def critical_interference(self) -> float:
        """w_c / sigma, at which an asperity begins to yield."""
        return self.asperity_width / self.plasticity_index**2

    def mean_gap(self, separation: ArrayLike) -> FloatArray:
        """The gap [m] between the surfaces' mean planes; separations d / sigma count from the asperities' mean."""
        return (np.asarray(separation, dtype=float) + MEAN_PLANE / self.asperity_beta) * self.roughness

    def forces(self, separation: ArrayLike) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Load P, adhesion F_s and friction limit Q [N] at separations d / sigma of any shape: equations (3)-(5)."""
        d = np.asarray(separation, dtype=float)
        flat = d.ravel()
        w, width = self.critical_interference, self.asperity_width
        eps = self.intermolecular_distance / self.roughness
        k = 0.454 + 0.41 * self.poisson_ratio

        def i(power: float, low: float, high: float) -> FloatArray:
            return w * from_power(flat, power, low, high, w, width)

        def j(power: float, scale: float, low: float, high: float) -> FloatArray:
            return i(power, low, high) * (eps / w) ** scale

        load = i(1.5, 0, 1) + 1.03 * i(1.425, 1, 6) + 1.4 * i(1.263, 6, 110) + 3 / k * i(1, 110, math.inf)
        near = 4 / 3 * on_panels(flat, eps, width)
        touching = 0.98 * j(0.298, -0.29, 0, 1) + 0.79 * j(0.356, -0.321, 1, 6) + 1.19 * j(0.093, -0.332, 6, 110)
        bracket, factor = SHEAR[self.coefficients]
        shear = 0.52 * i(0.982, 0, 1)
        shear = shear + factor * sum(c * i(power, 1, 6) for c, power in zip(bracket, SHEAR_POWERS, strict=True))
        unit = self.hardness * self.contact_area * math.pi * self.asperity_beta
        theta = self.adhesion_energy / (self.roughness * self.hardness)
        values = (2 / 3 * unit * k * w * load, 2 * unit * theta * (near + touching), 2 / 3 * unit * k * w * shear)
        p, f_s, q = (np.reshape(value, d.shape) for value in values)
        return p, f_s, q

    def far_adhesion(self, separation: ArrayLike) -> FloatArray:
        """F_s [N] at separations d / sigma (n,) beyond the reach of all asperities, to rounding from d = 40 on."""
        nodes, weights = np.polynomial.hermite_e.hermegauss(24)
        eps = self.intermolecular_distance / self.roughness
        gap = eps + np.asarray(separation, dtype=float)[:, None] - self.asperity_width * nodes
        near = 4 / 3 * ((eps / gap) ** 2 - 0.25 * (eps / gap) ** 8) @ (weights / math.sqrt(2 * math.pi))
        unit = self.contact_area * math.pi * self.asperity_beta * self.adhesion_energy / self.roughness
        return np.asarray(2 * unit * near)

    def on_face(self, footprint: Footprint, hessian: ArrayLike = ((0.0, 0.0), (0.0, 0.0))) -> FaceLaw:
        """The contact of a face with a surface that is curved under it: this law, point by point, over its own area.

        Parameters
        ----------
        footprint : Footprint
            The face. Its own area counts, not `contact_area`.
        hessian : (2, 2) array
            Second derivatives of the surface under the face, 1/m, in the face's axes; negative on a hump.

        Returns
        -------
        law : FaceLaw
            With `pull_off` and `largest_load` [N], `friction_limit(load)` [N] and `torque_limit(load)` [N m].

        Raises
        ------
        ValueError
            The Hessian is no symmetric matrix.
        """
        return FaceLaw(self, footprint, hessian)

    def net_load(self, separation: ArrayLike) -> FloatArray:
        """P - F_s [N] at separations of any shape."""
        load, adhesion, _ = self.forces(separation)
        return load - adhesion

    @cached_property
    def branch(self) -> tuple[float, float]:
        """The separations d / sigma between which the contact is stable and friction grows with the load.

        From the peak of Q (closer, fully plastic asperities carry none) to pull-off. Raises ValueError when the
        parameters leave no such branch.
        """
        grid = np.linspace(0.0, 8.0, 401)
        load, adhesion, limit = self.forces(grid)
        net = load - adhesion
        least, peak = int(np.argmin(net)), int(np.argmax(limit))
        whole = 0 < least < len(grid) - 1 and net[least] < 0 and peak < least
        rises = (np.diff(net[peak : least + 1]) < 0).all() and (np.diff(limit[peak : least + 1]) < 0).all()
        if not (whole and rises and limit[least] > 0):
            raise ValueError(
                "Inputs of KogutEtsion must give a pull-off force and a friction limit that grows with the load; "
                f"these do not (least net load {net[least]:.3g} N at d = {grid[least]:.3g} sigma)"
            )
        top = lowest(lambda d: -self.forces(d)[2], grid[max(peak - 1, 0)], grid[peak + 1])
        return top, lowest(self.net_load, grid[least - 1], grid[least + 1])

    @cached_property
    def pull_off(self) -> float:
        """The force [N] that pulls the surfaces apart, positive."""
        return -float(self.net_load(self.branch[1]))

    @cached_property
    def largest_load(self) -> float:
        """The net load [N] where Q peaks, or at d = 0 if it has not by then; the law ends there."""
        return float(self.net_load(self.branch[0]))

    def separation(self, net_load: ArrayLike) -> FloatArray:
        """The stable separation d / sigma under net loads [N] of any shape; ValueError for one outside the law."""
        from scipy.optimize import brentq  # here, because no run needs it

        loads = np.asarray(net_load, dtype=float)
        check_loads(loads, self.pull_off, self.largest_load)
        low, high = self.branch
        ends = self.largest_load, -self.pull_off

        def solve(load: float) -> float:
            if load in ends:
                return low if load == ends[0] else high
            return float(brentq(lambda d: float(self.net_load(d)) - load, low, high, xtol=1e-13, rtol=1e-14))

        return np.reshape([solve(load) for load in loads.ravel().tolist()], loads.shape)

    def friction_limit(self, net_load: ArrayLike) -> FloatArray:
        """Q [N] under net loads [N] of any shape, from the integrator's table; ValueError for one outside the law."""
        return friction_limits(self.law, net_load)

    @property
    def law(self) -> FrictionLaw:
        """Cubic spline of ln Q over u = ln(1 + sqrt((N + pull_off) / pull_off)), smooth at the fold of pull-off.

        Its knots are uniform in u, so that a lookup needs no search, and as many as an error of 1e-9 takes.
        """
        return self._tabulated[0]

    @property
    def table_error(self) -> float:
        """A bound of the relative error of `friction_limit` at loads from 1e-9 pull-offs above pull-off on.

        Twice the largest error found against the contact itself, at three points between all neighbouring knots, and
        what rounding of the loads adds. Closer to pull-off rounding counts for more: see docs/contact.md.
        """
        return self._tabulated[1]

    @cached_property
    def _tabulated(self) -> tuple[FrictionLaw, float]:
        from scipy.interpolate import CubicSpline  # here, because other laws do without it

        low, high = self.branch
        d = high - (high - low) * np.linspace(0, 1, SAMPLES)
        u, _ = self._stretched(d)
        separation = CubicSpline(u, d)
        for intervals in INTERVALS:
            knots = np.linspace(0, u[-1], intervals + 1)
            # Not quite at the knots, as the separations there are interpolated; but the pairs of u and Q are exact.
            table = CubicSpline(knots, CubicSpline(*self._stretched(separation(knots)))(knots))
            between = (knots[:-1, None] + knots[1] * np.array([0.25, 0.5, 0.75])).ravel()
            place, exact = self._stretched(separation(between))
            error = 2 * float(np.abs(np.expm1(table(place) - exact)).max())
            if error <= MAX_ERROR:
                break
        # An error e of the load over pull-off changes u by e / (2 u) there.
        rounded = ROUNDING * float(self.forces(high)[1]) / self.pull_off
        error += rounded / (2 * math.sqrt(NEAREST)) * float(table(0.0, 1))
        cubics = np.ascontiguousarray(table.c)
        return new_law(TABLE, self.pull_off, self.largest_load, step=float(knots[1]), pieces=cubics), error

    def _stretched(self, d: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The table's variable u and ln Q at separations (n,), the first of which may be pull-off."""
        load, adhesion, limit = self.forces(d)
        above = (load - adhesion) / self.pull_off + 1
        above[d == self.branch[1]] = 0.0
        return np.log1p(np.sqrt(np.maximum(above, 0.0))), np.log(limit)
