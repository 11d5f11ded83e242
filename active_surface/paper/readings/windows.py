"""Windows: at which strokes and frequencies a device places parts on an actuator, and hands them to the next one."""

from __future__ import annotations

from dataclasses import replace
from itertools import product
from typing import Any, Final, NamedTuple

import numpy as np

from active_surface.arrays import FloatArray
from active_surface.paper.figures import Handover, arrives
from active_surface.paper.models import DEVICE, Bench
from active_surface.paper.readings.devices import BLOCK, TILE, Device
from active_surface.paper.readings.losses import FARTHEST, NEAREST
from active_surface.paper.share import share_of
from coupling import Progress, silent
from particle import Drive

THICKNESS: Final = 5e-6  # m
RADII: Final = (300e-6, 600e-6)  # m
STROKES: Final = (5e-6, 10e-6, 20e-6, 40e-6)  # m
FREQUENCIES: Final = tuple((500 * 2 ** (np.arange(19) / 4)).tolist())  # Hz
RATIOS: Final = (4 / 3, 1.5, 0.0)  # of the fast actuator's frequency over the slow one's; 0: it rests
CYCLES: Final = 120  # small strokes carry a part by little in each
HALF: Final = 0.5  # of the parts at least must converge to one actuator at a frequency for two of them to be tried
MOVED: Final = 1e-6  # m


class Window(NamedTuple):
    """What becomes of parts at rest around one actuator."""

    radius: float  # m
    part: str
    stroke: float  # m
    frequency: float  # Hz
    converge: float  # share
    lost: float  # share that comes off, goes over the rim or is not followed to the end
    held: float  # share that friction holds where it was placed
    away: float  # m, the median distance of those on the surface in the end


class Passage(NamedTuple):
    """What becomes of parts at rest around the fast one of two actuators."""

    radius: float  # m
    part: str
    stroke: float  # m
    frequency: float  # Hz, of the slow one
    ratio: float
    arrive: float  # share that converges to the slow one
    lost: float


class Windows(NamedTuple):
    """A search."""

    placing: list[Window]
    passing: list[Passage]


class Grid(NamedTuple):
    """What is searched."""

    radii: tuple[float, ...] = RADII
    strokes: tuple[float, ...] = STROKES
    frequencies: tuple[float, ...] = FREQUENCIES
    starts: int = 8


def windows_of(grid: Grid, progress: Progress = silent) -> Windows:
    """Both searches, for both parts; parts over one plate share its surfaces."""
    top = max(grid.strokes)
    every = list(product(grid.radii, (TILE, BLOCK), grid.strokes))
    grounds: dict[float, Any] = {radius: {} for radius in grid.radii}
    found = Windows([], [])
    with progress("Searching windows") as tell:
        for k, (radius, part, stroke) in enumerate(every):
            own = Device(radius, THICKNESS, part).parameters()
            bench = Bench(replace(own, stroke=top, strokes=(top, top), cycles=CYCLES), grounds=grounds[radius])
            rows = [_window(bench, part, stroke, frequency, grid.starts) for frequency in grid.frequencies]
            good = [row.frequency for row in rows if row.converge >= HALF]
            found.placing.extend(rows)
            found.passing.extend(_passage(bench, part, stroke, *one, grid.starts) for one in product(good, RATIOS))
            tell(k + 1, len(every))
    return found


def _window(bench: Bench, part: str, stroke: float, frequency: float, starts: int) -> Window:
    p, drive = bench.parameters, bench.drive(frequency, stroke)
    places = np.column_stack([np.linspace(NEAREST, FARTHEST, starts), np.zeros(starts)])
    paths = bench.paths(DEVICE, [drive], places, bench.duration(drive))
    there = [path.away()[-1] for path in paths if path.attached]
    return Window(
        p.radius, part, stroke, frequency,
        share_of(path.converged(1 / drive.frequency, p.near) for path in paths).value,
        share_of(not path.attached for path in paths).value,
        share_of(path.trajectory.path_length < MOVED for path in paths).value,
        float(np.median(there)) if there else float("nan"),
    )  # fmt: skip


def _passage(bench: Bench, part: str, stroke: float, frequency: float, ratio: float, starts: int) -> Passage:
    """The slow actuator is at (pitch, 0)."""
    p = bench.parameters
    fast = bench.drive(frequency * ratio, stroke) if ratio else Drive(0.0, bench.drive(frequency).frequency)
    drives = [fast, bench.drive(frequency, stroke)]
    paths = bench.paths(
        DEVICE, drives, around(p.pitch, p.seed, starts), bench.duration(drives[1]), actuators="superposed"
    )
    if ratio:
        share = share_of(arrives(bench, Handover((frequency * ratio, frequency), (0.0, 0.0)), path) for path in paths)
    else:
        share = share_of(path.converged(1 / drives[1].frequency, p.near, (p.pitch, 0.0)) for path in paths)
    return Passage(
        p.radius, part, stroke, frequency, ratio, share.value, share_of(not path.attached for path in paths).value
    )


def around(pitch: float, seed: int, count: int) -> FloatArray:
    """Places (count, 2) [m] in the region of an actuator: within half a pitch [m], and not at it."""
    random = np.random.default_rng(seed)
    angle, away = 2 * np.pi * random.random(count), pitch / 2 * np.sqrt(random.uniform(0.1, 1.0, count))
    return np.stack([away * np.cos(angle), away * np.sin(angle)], axis=1)
