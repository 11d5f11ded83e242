"""From the drives of a case to those of the integrator: their heights, extremes and jumps."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from coupling.case import ENDLESS, Case, DriveCase, amplitude
from particle import AnyDrive, Drive, Segment, SegmentDrive, TableDrive
from particle.drives import ORDER, drive_table, next_breakpoint

FloatArray = NDArray[np.float64]

SAMPLES, MAX_BREAKPOINTS = 201, 101  # moments at which extremes are sought
MAX_ADDED, ENOUGH = 256, 0.99  # moments added for extremes that lie elsewhere; this share of an extreme is enough
GOLDEN = (5**0.5 - 1) / 2
PARTS = 8  # of a piece, between which its largest acceleration is sought
JUMP = 1e-3  # of a stroke over its time: a smaller change of velocity counts as none


def build_drives(case: Case) -> list[AnyDrive]:
    """The actuators' drives; those of forces are in N."""
    return [build_drive(actuator) for actuator in case.actuators]


def build_drive(drive: DriveCase) -> AnyDrive:
    """One drive: a table, a schedule of segments, or one cycle over and over."""
    repeats = None if drive.repeats == ENDLESS else drive.repeats
    if drive.table is not None:
        times, heights = np.array(drive.table).T
        return TableDrive(times, heights, repeats, drive.delay)
    if drive.segments is not None:
        return SegmentDrive([Segment(**segment.model_dump()) for segment in drive.segments], repeats, drive.delay)
    timing = (drive.cycle, drive.cycles, drive.delay, drive.dwell, drive.phase, drive.ramp)
    return Drive(amplitude(drive), drive.frequency or 0.0, *timing)


def stroke_heights(drives: Sequence[AnyDrive], times: FloatArray, derivative: int = 0) -> FloatArray:
    """The heights h_i(t) [m] of the drives, or a derivative [m/s, m/s^2], at times (k,) [s]: (k, N)."""
    known: dict[AnyDrive, FloatArray] = {}
    for drive in drives:
        if drive not in known:  # many of a lattice are equal
            known[drive] = drive.evaluate(times)[derivative]
    return np.stack([known[drive] for drive in drives], axis=1)


def fastest(drives: Sequence[AnyDrive]) -> float:
    """The frequency [Hz] of the fastest drive that moves; 0 where none does."""
    return max((drive.frequency for drive in dict.fromkeys(drives) if travel(drive) > 0), default=0.0)


def moments(drives: Sequence[AnyDrive], end: float) -> FloatArray:
    """Moments (k,) from 0 to `end` [s] at which to look for extremes.

    They are the first breakpoints of the drives, moments spread evenly, and those of extremes that both leave out.
    """
    breakpoints, table = [0.0], drive_table(drives)
    while len(breakpoints) < MAX_BREAKPOINTS and breakpoints[-1] < end:
        breakpoints.append(min(next_breakpoint(table, breakpoints[-1]), end))
    scattered = end * (np.arange(SAMPLES) * GOLDEN % 1.0)
    common = np.unique(np.concatenate([breakpoints, scattered, [end]]))
    overlooked = []
    for drive in dict.fromkeys(drives):  # many of a lattice are equal
        at_common = drive.evaluate(common)[0]
        times, heights = _marks(drive)
        for signed, known in ((heights, at_common), (-heights, -at_common)):
            signed = np.where(times <= end, signed, -np.inf)
            most = int(np.argmax(signed))
            if ENOUGH * signed[most] > max(0.0, known.max()):
                overlooked.append((float(signed[most]), float(times[most])))
    return np.union1d(common, [time for _, time in sorted(overlooked, reverse=True)[:MAX_ADDED]])


def _marks(drive: AnyDrive) -> tuple[FloatArray, FloatArray]:
    """When [s] its pieces begin, are half over and end for the first time (k,), and the heights [m] there (k,)."""
    pieces = drive.segments()
    part = np.array([0.0, 0.5, 1.0])
    times = drive.delay + (pieces.since[:, None] + pieces.scale[:, None] * part).ravel()
    return times, (pieces.coefficients @ np.power.outer(part, np.arange(ORDER)).T).ravel()


def fastest_acceleration(drive: AnyDrive) -> float:
    """The largest acceleration [m/s^2] at points within its pieces: strokes have none at their ends and middles."""
    pieces, part = drive.segments(), np.linspace(0.0, 1.0, PARTS + 1)
    powers = np.arange(2, ORDER)
    bends = (pieces.coefficients[:, 2:] * powers * (powers - 1)) @ np.power.outer(part, powers - 2).T
    return float(np.abs(bends / pieces.scale[:, None] ** 2).max())


def travel(drive: AnyDrive) -> float:
    """The distance [m] between the lowest and the highest of its marks."""
    low, high = reach(drive)
    return high - low


def reach(drive: AnyDrive) -> tuple[float, float]:
    """The lowest and the highest of its marks [m]."""
    heights = _marks(drive)[1]
    return float(heights.min()), float(heights.max())


def first_jump(drives: Sequence[AnyDrive], end: float) -> float | None:
    """The first time [s] between 0 and `end` at which a drive's velocity jumps; None: at none."""
    times = []
    for drive in dict.fromkeys(drives):  # many of a lattice are equal
        near, pieces = 1e-6 * drive.stroke_time, drive.segments()
        edges = drive.delay + np.append(pieces.since, pieces.duration)
        edges = edges[(edges > 0) & (edges < end)]
        before, after = (drive.evaluate(edges + side)[1] for side in (-near, near))
        times += edges[np.abs(after - before) > JUMP * travel(drive) / drive.stroke_time].tolist()
    return min(times, default=None)
