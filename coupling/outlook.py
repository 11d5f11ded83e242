"""Outlook: what a run would warn of, as far as a case shows it, and what its actuators are asked for beyond limits."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from common import quantity_text
from coupling.case import ActuatorCase, Case, PlateCase, half_size
from coupling.case.plates import ShapeCase

if TYPE_CHECKING:
    from fem_plate import PlateShapes

FloatArray = NDArray[np.float64]

MAX_DENSITY = 23_000.0  # kg/m^3: osmium has 22 590
MAX_THICKNESS = 0.1  # of the plate's longer side
MAX_FREQUENCY = 0.015  # of the plate's first: strokes up and down are then off by 5 % in acceleration
DISC = 10.21583 / (2 * math.pi)  # of a clamped disc's first frequency, over sqrt(D / rho t) / radius^2
SLACK = 1 + 1e-6  # of a limit that is met exactly
SAMPLES = 60  # points across the plate between which its widest gap is sought


def case_warnings(case: Case) -> list[str]:
    """What is seldom intended: a part heavier than any solid, a drive longer than the run, a plate that is a block."""
    found, part, duration = [], case.part, case.run.duration
    if part.size is not None:
        height = 2 * part.centre_height if part.centre_height else part.size
        density = part.mass / (part.size**2 * height)
        if density > MAX_DENSITY:
            as_high = "" if part.centre_height else " if it is as high as wide"
            found.append(
                f"The part has {density:.2g} kg/m^3{as_high}; no solid has more than {MAX_DENSITY:,.0f}. Check "
                "part.mass and part.size."
            )
    moving = [(index, drive) for index, drive in enumerate(case.actuators) if drive.stroke or drive.force]
    ends = [(_end(drive), index) for index, drive in moving]
    late = [(end, index) for end, index in ends if end > duration * (1 + 1e-9)]
    if late:
        end, index = max(late)
        who = f"The drive of actuator {index} takes" if len(late) == 1 else f"{len(late)} drives take up to"
        found.append(
            f"{who} {quantity_text(end, 's')}, and the run ends after {quantity_text(duration, 's')}: the rest does "
            "not happen."
        )
    if isinstance(case.plate, ShapeCase):
        thickness, width, length = case.plate.thickness, case.plate.measures[0], 2 * half_size(case.plate.coarse_mesh)
        if thickness > min(width, MAX_THICKNESS * length):
            found.append(
                f"The plate is {quantity_text(thickness, 'm')} thick, {quantity_text(width, 'm')} wide and "
                f"{quantity_text(length, 'm')} long; plate theory, which leaves out shear, holds up to a thickness of "
                "about a tenth of the length, and less than the width."
            )
    return found


def frequency_warnings(case: Case) -> list[str]:
    """That the fastest drive is too fast for a quasi-static plate, by a bound from above of its first frequency.

    Where the plate has no actuator within a disc, it can move there as that disc clamped at its edge, whatever else
    holds it (Rayleigh); so its first frequency is at most 10.2158 / (2 pi R^2) sqrt(D / (rho t)). Plates with inertia,
    a tension or a foundation, of a wafer or without a density are left out.
    """
    plate = case.plate
    if not isinstance(plate, PlateCase) or plate.inertia or plate.tension or plate.foundation or plate.density is None:
        return []
    if plate.youngs_modulus is None or plate.poisson_ratio is None:
        return []
    fastest = max((drive.frequency or 0.0 for drive in case.actuators if drive.stroke or drive.force), default=0.0)
    rigidity = plate.youngs_modulus * plate.thickness**3 / (12 * (1 - plate.poisson_ratio**2))
    first = DISC / _widest_gap(case, plate) ** 2 * math.sqrt(rigidity / (plate.density * plate.thickness))
    if fastest <= MAX_FREQUENCY * first:
        return []
    return [
        f"The fastest drive is at {fastest / first:.2g} of the plate's first frequency, or more; the quasi-static "
        f"model holds up to about {MAX_FREQUENCY}."
    ]


def _end(drive: ActuatorCase) -> float:
    """When [s] a drive of so many cycles ends; 0 of others."""
    if drive.cycles is None or not drive.frequency:
        return 0.0
    dwell = 2 * drive.dwell if drive.cycle == "up-down" else 0.0
    return drive.delay + drive.cycles * (1 / drive.frequency + dwell)


def _widest_gap(case: Case, plate: PlateCase) -> float:
    """The radius [m] of about the largest disc on the plate without an actuator in it."""
    outline = plate.coarse_mesh.outline
    low, high = outline.box
    axes = [np.linspace(low[k], high[k], SAMPLES) for k in (0, 1)]
    xy = np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 2)
    gap = outline.gap(xy)
    for actuator in case.actuators:
        gap = np.minimum(gap, np.hypot(*(xy - actuator.position).T))
    return float(gap.max())


def largest_forces(case: Case, shapes: PlateShapes | None = None) -> FloatArray:
    """The largest forces (N,) [N], up or down, that actuators take to follow their drives.

    By linear theory, P(t) = K h(t), and with a pressure what holds the plate against that, without inertia and without
    the part. shapes: those of the case, if known.
    """
    from coupling.drives import build_drives, moments, stroke_heights  # these take a second to load
    from coupling.scene import actuator_stiffness, build_plate
    from fem_plate import InfluenceShapes

    assert isinstance(case.plate, PlateCase)
    if shapes is None:
        points = [actuator.position for actuator in case.actuators]
        shapes = build_plate(case.plate).influence(points, actuator_stiffness(case))
    drives = build_drives(case)
    heights = stroke_heights(drives, moments(drives, case.run.duration))
    forces = shapes.stiffness @ heights.T
    if case.plate.pressure:
        assert isinstance(shapes, InfluenceShapes)
        forces = forces + shapes.pressure_forces(case.plate.pressure)[:, None]
    return np.asarray(np.abs(forces).max(axis=1))


def limit_warnings(case: Case, shapes: PlateShapes | None = None) -> list[str]:
    """One sentence where actuators take more than their max_force; none where all are within it."""
    limits = np.array([actuator.max_force or np.inf for actuator in case.actuators])
    if not np.isfinite(limits).any():
        return []
    forces = largest_forces(case, shapes)
    beyond = np.flatnonzero(forces > SLACK * limits)
    if not beyond.size:
        return []
    worst = int(beyond[np.argmax(forces[beyond] / limits[beyond])])
    who = f"{len(beyond)} actuators take" if len(beyond) > 1 else f"Actuator {worst} takes"
    most = f", actuator {worst} most" if len(beyond) > 1 else ""
    needed, limit = quantity_text(float(forces[worst]), "N"), quantity_text(float(limits[worst]), "N")
    assert isinstance(case.plate, PlateCase)
    more = "; a plate that stretches takes more" if case.plate.theory == "von-karman" else ""
    return [
        f"{who} more than max_force{most}: {needed} of {limit}, by linear theory without inertia{more}. Reduce the "
        "strokes, or let neighbours share them."
    ]
