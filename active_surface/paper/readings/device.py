"""Device: a real plate in place of the paper's profiles, with its top face, its stretching and its mass."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Final, NamedTuple

import numpy as np

from active_surface.paper.models import CLOSED, PLATE, Bench, Ground
from active_surface.paper.parameters import Parameters
from active_surface.paper.readings.reading import RIM, Reading, SweepSize
from active_surface.paper.readings.single import MAP, Shares, carried, converging, strokes_of, thresholds_of
from active_surface.paper.readings.two import of_two
from active_surface.paper.share import Share, share_of
from coupling import Progress, StretchedSurface, shared_surface, silent
from coupling.case import Case, PlateCase
from coupling.scene import build_plate
from coupling.stretch import Stretch
from fem_plate import Plate
from particle import Drive, SurfaceMotion

DENSITY: Final = 2330.0  # kg/m^3
LARGEST: Final = 200e-6  # m, of the strokes of one actuator
LONGEST: Final = 0.2  # s, of all runs
QUASI_STATIC: Final = 3.3  # error of the acceleration over frequency by first frequency (limits.md)


class Device(NamedTuple):
    """What a builder would see."""

    shares: Shares
    threshold: float  # Hz, nan: none
    come_off: Share  # at the stated stroke and 300 Hz, from distances of figure 18
    off_within: float  # m from the actuator, the median of where they do
    first_frequency: float  # Hz, of the plate with its actuator held
    inertia_error: float  # of the acceleration at the highest frequency of figure 18, over its largest
    strain: float  # the largest, at the stated stroke
    slope: float


class DeviceBench(Bench):
    """A bench whose every ground is a clamped plate after von Karman, on whose top face the part lies."""

    def ground(self, model: str, actuators: str = "one") -> Ground:
        """The same plate for all models."""
        key = (PLATE, "one" if actuators == "one" else "two")
        if key not in self.grounds:
            points = _points(self.parameters, key[1])
            stroke = LARGEST if key[1] == "one" else self.parameters.stroke
            case = case_of(self.parameters, points)
            surface = shared_surface(case, [[Drive(stroke, 300.0)] * len(points)], LONGEST)
            self.grounds[key] = Ground(surface, _plate(case).mesh.outline, points[0])
        return self.grounds[key]

    def surface(self, model: str, drives: Sequence[Drive], actuators: str, duration: float) -> SurfaceMotion:
        """The ground under drives, up to a time [s]."""
        plate = self.ground(model, actuators).surface
        assert isinstance(plate, StretchedSurface)
        return plate.until(duration).driven_by(drives)


def _points(p: Parameters, actuators: str) -> np.ndarray:
    """Places (n, 2) [m] of actuators on a plate whose centre is half-way between them."""
    points = np.array([[0.0, 0.0]] if actuators == "one" else [[0.0, 0.0], [p.pitch, 0.0]])
    return points - points.mean(axis=0)


def case_of(p: Parameters, points: np.ndarray) -> Case:
    """The case of a clamped, immovable disc."""
    plate = {
        "shape": "disc", "radius": p.radius, "supports": "clamped", "youngs_modulus": p.youngs_modulus,
        "poisson_ratio": p.poisson_ratio, "thickness": p.thickness, "density": DENSITY, "theory": "von-karman",
    }  # fmt: skip
    actuators = [{"position": tuple(point), "stroke": p.stroke, "frequency": 300.0} for point in points.tolist()]
    part = {"mass": p.mass, "position": (100e-6, 0.0)}
    friction = {"model": "kogut-etsion", "preset": "paper"}
    run = {"duration": LONGEST, "gravity": p.gravity}
    return Case(plate=plate, actuators=actuators, part=part, friction=friction, run=run)


def _plate(case: Case) -> Plate:
    assert isinstance(case.plate, PlateCase)
    return build_plate(case.plate)


def device_of(reading: Reading, size: SweepSize, progress: Progress = silent) -> Device:
    """What the statements come to on a plate of the reading's radius; their friction is the rough contact."""
    bench = DeviceBench(replace(reading.parameters()))
    p = bench.parameters
    with progress("Following parts on a real plate"):
        threshold, level = thresholds_of(bench, CLOSED, size)
        benches: dict[str, Bench] = {RIM: bench}
        shares = (
            strokes_of(bench, CLOSED)
            | carried(benches, CLOSED, size)
            | converging(bench, CLOSED, size)
            | threshold
            | of_two(benches, PLATE, size)
        )
        drive = bench.drive(300.0)
        starts = np.column_stack([np.linspace(40e-6, 160e-6, 2 * size.starts), np.zeros(2 * size.starts)])
        paths = bench.paths(CLOSED, [drive], starts, bench.duration(drive))
        off = [path.off_at([(0.0, 0.0)])[0] for path in paths if path.came_off]
        case = case_of(p, _points(p, "one"))
        first = float(_plate(case).modes(1, held=[(0.0, 0.0)]).frequencies[0])
        surface = bench.ground(CLOSED).surface
        assert isinstance(surface, StretchedSurface) and surface.model is not None
        extremes = Stretch.under(surface.model, [drive], 1 / drive.frequency).extremes
    return Device(
        shares, level, share_of(path.came_off for path in paths), float(np.median(off)) if off else float("nan"), first,
        QUASI_STATIC * float(MAP[-1]) / first, extremes.strain, extremes.slope,
    )  # fmt: skip
