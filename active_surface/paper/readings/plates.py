"""Plates: what a device's plate goes through at a stroke, and what its mass adds to a path."""

from __future__ import annotations

from dataclasses import replace
from typing import Final, NamedTuple

import numpy as np

from active_surface.paper.device import device_case, device_surface
from active_surface.paper.models import RINGS, Bench
from active_surface.paper.parameters import Parameters
from coupling import shared_surface
from coupling.stretch import Stretch
from fem_plate import Plate, PlateSection
from meshes import disc
from particle import Micropart, simulate

ALONE: Final = np.zeros((1, 2))  # m: one actuator in the middle
DRIVEN: Final = 300.0  # Hz
CYCLES: Final = 2  # in which no path is chaotic yet
TOLERANCE: Final = 1e-9  # of located events, where two paths are compared


class Strained(NamedTuple):
    """A plate with one actuator at its full stroke."""

    radius: float  # m
    thickness: float  # m
    stroke: float  # m
    slope: float  # the largest
    strain: float  # the largest at a face, half a thickness and more off the actuator
    force: float  # N, of the actuator
    linear: float  # N, the same in linear theory
    frequency: float  # Hz, the first with the actuator held, of the flat plate


def strained(p: Parameters, stroke: float) -> Strained:
    """What a plate goes through at a stroke [m]."""
    top = replace(p, strokes=(stroke, stroke))
    model = device_surface(top, ALONE).model
    assert model is not None
    drives, end = [Bench(top).drive(DRIVEN, stroke)], 1 / DRIVEN
    extremes = Stretch.under(model, drives, end).extremes
    force = float(model.large.solve([stroke]).reactions[0])
    plate = plate_of(p)
    linear = 16 * np.pi * plate.section.rigidity * stroke / p.radius**2
    frequency = float(plate.frequencies(1, ALONE)[0])
    return Strained(p.radius, p.thickness, stroke, extremes.slope, extremes.strain, force, float(linear), frequency)


def plate_of(p: Parameters) -> Plate:
    """A device's plate in linear theory."""
    section = PlateSection(p.youngs_modulus, p.poisson_ratio, p.thickness, p.density)
    return Plate(disc(p.radius, p.radius / RINGS), section)


class Inertia(NamedTuple):
    """The end of a path with the plate's mass beside that without."""

    frequency: float  # Hz, of the drive
    first: float  # Hz, of the plate with its actuator held
    length: float  # m, of the path
    apart: float  # m, both ends


def inertia_of(p: Parameters) -> Inertia:
    """A part at the paper's start under the paper's stroke, for some cycles."""
    drives = [Bench(p).drive(DRIVEN, p.stroke)]
    duration = CYCLES / DRIVEN
    part = Micropart(p.mass, p.start, centre_height=p.centre_height)
    paths = []
    for inertia in (False, True):
        surface = shared_surface(device_case(p, ALONE, p.stroke, inertia), [drives], duration)
        surface = replace(surface, half_thickness=p.half_thickness)
        paths.append(simulate(surface.driven_by(drives), part, p.friction, duration, p.gravity, TOLERANCE))
    without, with_mass = (path.position[-1] for path in paths)
    first = float(plate_of(p).frequencies(1, ALONE)[0])
    return Inertia(DRIVEN, first, paths[0].path_length, float(np.hypot(*(with_mass - without))))
