"""Verification: the finite-element plate against theory on three meshes, with errors, orders and bounds."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from fem_plate import analytic
from fem_plate.elements import Derivatives
from fem_plate.plate import Plate
from fem_plate.sections import PlateSection
from fem_plate.types import FloatArray
from meshes import disc

RADIUS = 300e-6  # m
SECTION = PlateSection(youngs_modulus=169e9, poisson_ratio=0.3, thickness=5e-6, density=2330.0)
FORCE = 1e-3  # N
CELLS_FROM_CENTRE = (7, 10, 14)
LAYOUT = RADIUS * np.array([[0.35, 0.10], [-0.20, -0.30]])
STROKES = np.array([1.0, -0.6])  # of a unit stroke
CLEARANCE = 0.02  # of the radius: errors are taken this far from the actuators, where the Hessian is infinite
QUANTITIES = ("w", "gradient", "hessian")
ERROR_BOUNDS = (1e-8, 2e-7, 1e-5)  # relative largest errors on the finest mesh
ORDER_BOUNDS = (5.0, 4.0, 3.0)
ROUNDING = 1e-9  # errors below this come from rounding and have no order
MAX_UNKNOWNS = 6000


@dataclass(frozen=True)
class Check:
    """One case of the verification."""

    name: str
    unknowns: tuple[int, ...]  # on each mesh
    errors: dict[str, tuple[float, ...]]  # relative largest error of each quantity on each mesh
    orders: dict[str, float | None]  # of each quantity; None where the errors are rounding
    failures: tuple[str, ...]

    @property
    def passed(self) -> bool:
        return not self.failures

    def as_dict(self) -> dict[str, Any]:
        return asdict(self) | {"passed": self.passed}


def verify() -> list[Check]:
    """Check a central load by equation (2) and an off-centre layout by Boggio's function, each on three meshes."""
    plates = [Plate(disc(RADIUS, RADIUS / cells), SECTION) for cells in CELLS_FROM_CENTRE]
    return [_central_load(plates), _off_centre(plates)]


def _central_load(plates: list[Plate]) -> Check:
    centre = np.zeros((1, 2))
    xy = _sample_points(centre)
    computed = [plate.deflection(centre, [FORCE]).evaluate(xy) for plate in plates]
    return _check("central load, equation (2)", plates, computed, _equation_2(xy))


def _equation_2(xy: FloatArray) -> Derivatives:
    """Equation (2) with its derivatives, w' = P r ln(r/a) / (4 pi D)."""
    r = np.hypot(*xy.T)
    unit = xy / r[:, None]
    factor = FORCE / (4 * np.pi * SECTION.rigidity)
    logarithm = np.log(r / RADIUS)
    radial = unit[:, :, None] * unit[:, None, :]
    w = analytic.central_load(r, RADIUS, SECTION.rigidity, FORCE)
    gradient = factor * (r * logarithm)[:, None] * unit
    return w, gradient, factor * (logarithm[:, None, None] * np.eye(2) + radial)


def _off_centre(plates: list[Plate]) -> Check:
    xy = _sample_points(LAYOUT)
    computed = [plate.influence(LAYOUT).evaluate(xy, STROKES) for plate in plates]
    exact = analytic.DiscShapes(LAYOUT, RADIUS).evaluate(xy, STROKES)
    return _check("two off-centre actuators, Boggio", plates, computed, exact)


def _sample_points(actuators: FloatArray) -> FloatArray:
    """The same random points (n, 2) [m] of the disc every time, clear of the actuators."""
    xy = RADIUS * np.random.default_rng(2).uniform(-1, 1, (12_000, 2))
    xy = xy[np.hypot(*xy.T) < RADIUS]
    return xy[np.min(np.linalg.norm(xy[:, None] - actuators, axis=2), axis=1) > CLEARANCE * RADIUS]


def _check(name: str, plates: list[Plate], computed: list[Derivatives], exact: Derivatives) -> Check:
    unknowns = tuple(plate.model().unknowns for plate in plates)
    errors, orders, failures = {}, {}, []
    if max(unknowns) > MAX_UNKNOWNS:
        failures.append(f"{max(unknowns)} unknowns, more than {MAX_UNKNOWNS}")
    for k, quantity in enumerate(QUANTITIES):
        of_meshes = tuple(float(np.abs(c[k] - exact[k]).max() / np.abs(exact[k]).max()) for c in computed)
        errors[quantity] = of_meshes
        order = float(-np.polyfit(np.log(CELLS_FROM_CENTRE), np.log(of_meshes), 1)[0])
        orders[quantity] = None if max(of_meshes) < ROUNDING else order
        if not of_meshes[-1] <= ERROR_BOUNDS[k]:
            failures.append(f"error of {quantity} {of_meshes[-1]:.1e}, more than {ERROR_BOUNDS[k]:.0e}")
        if orders[quantity] is not None and not order >= ORDER_BOUNDS[k]:
            failures.append(f"order of {quantity} {order:.2f}, less than {ORDER_BOUNDS[k]:g}")
    return Check(name, unknowns, errors, orders, tuple(failures))
