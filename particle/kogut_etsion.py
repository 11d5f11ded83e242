"""Kogut and Etsion's contact of rough surfaces: load, adhesion and friction limit over separation.

All lengths are divided by the roughness sigma. Asperity heights z follow a Gaussian phi of width s; an asperity higher
than the separation d is pressed by z - d, in units of the critical interference w_c. With

    I^b = ((z - d)/w_c)^b phi dz,      J_c^b = I^b (eps/w_c)^c,      J_nc = (4/3) [(eps/x)^2 - 0.25 (eps/x)^8] phi dz

where x = eps + d - z is the gap of an asperity that does not touch, equations (3)-(5) of the paper are sums of
integrals over ranges of interference. Corrections to their printed form are listed in docs/contact.md.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq, minimize_scalar

from particle.friction import TABLE, FrictionLaw, friction_limit
from particle.quadrature import from_power, on_panels

FloatArray = NDArray[np.float64]

PAPER_PLASTICITY_INDEX = 4.9128  # makes the friction limit 20.9 m/s^2 times the paper's mass at zero load
KNOTS = 1025
# Brackets of equation (5) beyond the first range: coefficients and powers.
SHEAR = {
    "printed": ((-0.01, 0.09, -0.4, 0.85), 1.0),
    "unrounded": ((-0.007, 0.085, -0.389, 0.822), 1.03),
}
SHEAR_POWERS = (4.425, 3.425, 2.425, 1.425)


@dataclass(frozen=True)
class KogutEtsion:
    """The contact of two rough surfaces under a normal load; the defaults are the paper's Table 1.

    coefficients: "printed" as in the paper's equation (5), "unrounded" as in the fit that it was rounded from.
    Raises ValueError, naming every field that is wrong.
    """

    roughness: float = 20e-9  # m, standard deviation of surface heights
    contact_area: float = 1e-8  # m^2, nominal
    hardness: float = 1.96133e9  # Pa
    poisson_ratio: float = 0.3
    adhesion_energy: float = 1.0  # J/m^2
    plasticity_index: float = 2.5
    asperity_beta: float = 0.0601  # asperity density times tip radius times roughness
    intermolecular_distance: float = 0.3e-9  # m
    coefficients: str = "printed"

    def __post_init__(self) -> None:
        wrong = []
        for field in fields(self):
            value = getattr(self, field.name)
            if field.name not in ("coefficients", "poisson_ratio") and not (math.isfinite(value) and value > 0):
                wrong.append(f"Input {field.name} of KogutEtsion must be positive; got {value!r}")
        if not 0 <= self.poisson_ratio < 0.5:
            wrong.append(f"Input poisson_ratio of KogutEtsion must be in [0, 0.5); got {self.poisson_ratio!r}")
        if self.asperity_beta**2 <= 3.717e-4:
            wrong.append(f"Input asperity_beta of KogutEtsion must exceed 0.01928; got {self.asperity_beta!r}")
        if self.coefficients not in SHEAR:
            wrong.append(f"Input coefficients of KogutEtsion must be one of {list(SHEAR)}; got {self.coefficients!r}")
        if wrong:
            raise ValueError("; ".join(wrong))

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

    def net_load(self, separation: ArrayLike) -> FloatArray:
        """P - F_s [N] at separations of any shape."""
        load, adhesion, _ = self.forces(separation)
        return load - adhesion

    @cached_property
    def branch(self) -> tuple[float, float]:
        """The separations between which the contact is stable and friction grows with the load.

        From the peak of Q (closer, fully plastic asperities carry none) to pull-off. Raises ValueError when the
        parameters leave no such branch.
        """
        grid = np.linspace(0.0, 8.0, 401)
        load, adhesion, limit = self.forces(grid)
        net = load - adhesion
        least, peak = int(np.argmin(net)), int(np.argmax(limit))
        if not (0 < least < len(grid) - 1 and net[least] < 0 and peak < least):
            raise ValueError(
                "Inputs of KogutEtsion must give a pull-off force and a friction limit that grows with the load; "
                f"these do not (least net load {net[least]:.3g} N at d = {grid[least]:.3g} sigma)"
            )
        off = minimize_scalar(
            lambda d: float(self.net_load(d)), bounds=(grid[least - 1], grid[least + 1]), options={"xatol": 1e-9}
        )
        top = minimize_scalar(
            lambda d: -float(self.forces(d)[2]),
            bounds=(grid[max(peak - 1, 0)], grid[peak + 1]),
            options={"xatol": 1e-9},
        )
        return float(top.x), float(off.x)

    @cached_property
    def pull_off(self) -> float:
        """The force [N] that pulls the surfaces apart, positive."""
        return -float(self.net_load(self.branch[1]))

    @cached_property
    def largest_load(self) -> float:
        """The net load [N] where Q peaks, or at d = 0 if it has not by then; the law ends there."""
        return float(self.net_load(self.branch[0]))

    def separation(self, net_load: ArrayLike) -> FloatArray:
        """The stable separation d / sigma under net loads [N] of any shape.

        Raises ValueError for a load below -pull_off or above the peak of the friction limit.
        """
        loads = np.asarray(net_load, dtype=float)
        self._check(loads)
        low, high = self.branch
        ends = self.largest_load, -self.pull_off

        def solve(load: float) -> float:
            if load in ends:
                return low if load == ends[0] else high
            return float(brentq(lambda d: float(self.net_load(d)) - load, low, high, xtol=1e-13, rtol=1e-14))

        return np.reshape([solve(load) for load in loads.ravel().tolist()], loads.shape)

    def friction_limit(self, net_load: ArrayLike) -> FloatArray:
        """Q [N] under net loads [N] of any shape, from the table that the integrator uses.

        Raises ValueError as `separation` does.
        """
        loads = np.asarray(net_load, dtype=float)
        self._check(loads)
        return np.reshape([friction_limit(self.law, load) for load in loads.ravel().tolist()], loads.shape)

    @cached_property
    def law(self) -> FrictionLaw:
        """Cubic spline of ln Q over u = ln(1 + sqrt((N + pull_off) / pull_off)), smooth at the fold of pull-off.

        It is sampled anew on knots uniform in u, so that a lookup needs no search.
        """
        low, high = self.branch
        d = high - (high - low) * np.linspace(0, 1, KNOTS)
        net, limit = self._net_and_limit(d)
        # The first is pull-off: one rounding of it apart would show in the root.
        u = self._stretched(net - (net[0] + self.pull_off))
        fine = CubicSpline(u, np.log(limit))
        knots = np.linspace(0, u[-1], KNOTS)
        table = CubicSpline(knots, fine(knots))
        return FrictionLaw(
            TABLE,
            0.0,
            0.0,
            1.0,
            0.0,
            self.pull_off,
            self.largest_load,
            0.0,
            float(knots[1]),
            np.ascontiguousarray(table.c),
        )

    @cached_property
    def table_error(self) -> float:
        """The largest relative error of `friction_limit` against the contact itself, measured between the knots."""
        low, high = self.branch
        # Not at the fold itself, where rounding of the load alone moves Q by its square root.
        d = np.linspace(low, high, 402)[1:-2]
        net, limit = self._net_and_limit(d)
        return float(np.abs(self.friction_limit(net) / limit - 1).max())

    def _net_and_limit(self, d: FloatArray) -> tuple[FloatArray, FloatArray]:
        load, adhesion, limit = self.forces(d)
        return load - adhesion, limit

    def _stretched(self, net: FloatArray) -> FloatArray:
        above = np.maximum((net + self.pull_off) / self.pull_off, 0.0)
        return np.log1p(np.sqrt(above))

    def _check(self, loads: FloatArray) -> None:
        below, above = ~(loads >= -self.pull_off), loads > self.largest_load
        if below.any():
            raise ValueError(
                f"Input net_load must be at least minus the pull-off force, {-self.pull_off:.6g} N; "
                f"got {loads[below].min():.6g} N"
            )
        if above.any():
            raise ValueError(
                f"Input net_load must be at most {self.largest_load:.6g} N, where the friction law ends; "
                f"got {loads[above].max():.6g} N"
            )
