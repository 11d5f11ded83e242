"""Feasibility of a case: where, and at which frequencies and strokes, its array moves its part without losing it.

case -> ground (plate, surface) -> chart of borders (slip, single runs) -> validity -> areas over the plate, if wanted
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

import numpy as np

from active_surface.arrays import FloatArray
from active_surface.studies.feasibility.area import (
    ACROSS,
    MAX_STROKES,
    Feasible,
    find_feasible,
    find_feasible_anew,
    moving,
)
from active_surface.studies.feasibility.chart import (
    Chart,
    Column,
    State,
    find_column,
    make_chart,
    nearest,
)
from active_surface.studies.feasibility.ground import Ground, make_ground, valid_strokes
from active_surface.studies.feasibility.places import Place
from active_surface.studies.feasibility.result import Feasibility
from active_surface.studies.response import range_fault
from common import quantity_text
from coupling import Progress, borders, build_drives, build_part, check_case, one_blas_thread, silent
from coupling.case import Case, PlateCase, largest_stroke
from coupling.ringing import RingingModel
from coupling.vibration import VibrationModel, always_running
from particle import interruptible
from particle.drives import drive_table, horizon

SPAN: Final = 0.25, 8.0  # times the case's own frequency
# Times its own strokes; a plate that stretches is solved up to the largest of them.
STROKES, STRETCHED = (2.0**-10, 16.0), (2.0**-10, 2.0)
DEFAULTS: Final = "a quarter of the case's", "eight times the case's"
COUNT: Final = 31  # frequencies of the areas
MAX_CYCLES: Final = 100  # of the case's fastest drive, over which the chart's runs last at most
COLUMNS, MAX_COLUMNS = 11, 32  # of the chart, at first and at most
FEW_COLUMNS, MAX_FEW = 6, 12  # where each path takes a motion of the plate
BORDERS, AREAS = "Finding which strokes move the part", "Finding where the part slips"


def feasibility(
    case: Case,
    lowest: float | None = None,
    highest: float | None = None,
    across: int = ACROSS,
    progress: Progress = silent,
    smallest: float | None = None,
    largest: float | None = None,
    threads: int | None = None,
    areas: bool = False,
) -> Feasibility:
    """Where the array of a case moves its part, over frequency and stroke, and if wanted over the plate.

    Parameters
    ----------
    case : Case
        The case.
    lowest, highest : float, optional
        Frequencies of its fastest drive that are looked at, Hz, by default a quarter of its own and eight times that;
        all times of all drives shrink likewise. Of segments the highest frequency counts, of a table that of strokes as
        short as its shortest, of a drive at rest none.
    across : int
        Places along the plate's longer side, at which areas are looked for.
    progress : Progress, optional
        Reports the progress of a stage.
    smallest, largest : float, optional
        Its largest stroke or height, m, or force where all actuators are forces, N: between which it is varied, by
        default from 1/1024 to 16 times its own, on a plate that stretches to twice its own.
    threads : int, optional
        Number of paths at a time, by default one on each processor; the result is the same for any.
    areas : bool
        Also find where on the plate a part slips and stays attached, over frequency, which takes longer than the chart.

    Returns
    -------
    feasibility : Feasibility
        The chart of runs from the case's start, which last as long as the case's, at most MAX_CYCLES; and the areas, or
        None. Their window is what the drives do until they repeat themselves, at most the run's duration, and of that
        no more than `active_surface.studies.feasibility.area` looks at. A plate with inertia answers each frequency
        anew, in the steady state or from rest as `run.start` says; from rest the window is the run's beginning.

    Raises
    ------
    ValueError
        No case, a platform, drives of which none moves, numbers that make no sense, or a mode without damping that
        resonates in a steady state.
    """
    check_case(case, "case of feasibility")
    every = build_drives(case)  # one that rests has a frequency, too, which counts for nothing
    drives = [drive for drive, moves in zip(every, moving(drive_table(every)), strict=True) if moves]
    frequency = max((drive.frequency for drive in drives), default=0.0)
    stroke, unit = largest_stroke(case)
    low = SPAN[0] * frequency if lowest is None else lowest
    high = SPAN[1] * frequency if highest is None else highest
    spans = STRETCHED if isinstance(case.plate, PlateCase) and case.plate.theory == "von-karman" else STROKES
    least = spans[0] * stroke if smallest is None else smallest
    most = spans[1] * stroke if largest is None else largest
    if not case.actuators:
        raise ValueError("Input case of feasibility must have a plate on actuators; got a platform")
    if case.air is not None and case.air.film:
        raise ValueError("Input case of feasibility must have air.film = false: a chart is of parts without a film")
    if areas and case.part.local_contact:
        raise ValueError("Input areas of feasibility must be false with part.local_contact")
    if not frequency:
        raise ValueError("Input case of feasibility must have a drive that moves; got none")
    if fault := range_fault("feasibility", lowest, highest, low, high, DEFAULTS):
        raise ValueError(fault)
    if not 0 < least < most < math.inf:
        raise ValueError(
            f"Input {'largest' if smallest is None else 'smallest'} of feasibility must leave a range of strokes; got "
            f"{quantity_text(least, unit)} to {quantity_text(most, unit)}"
        )
    if not 10 <= across <= 1000:
        raise ValueError(f"Input across of feasibility must be in [10, 1000]; got {across}")
    with one_blas_thread():
        factors, strokes = np.geomspace(low, high, COUNT) / frequency, (least / stroke, most / stroke)
        shortest = min(drive.stroke_time for drive in drives)
        running = [always_running(drive) for drive in drives] if case.run.start == "steady" else drives
        repeated = horizon(drive_table(running), 0.0)
        whole = case.run.duration if repeated is None else min(repeated, case.run.duration)
        duration = min(case.run.duration, max(drive.delay for drive in drives) + MAX_CYCLES / frequency)
        end = max(duration, min(whole, MAX_STROKES * shortest) / min(1.0, float(factors[0])))
        ground = make_ground(
            case, (min(float(factors[0]), 1.0), max(float(factors[-1]), 1.0)), strokes, duration, end, progress
        )
        chart = _chart(ground, factors, strokes, progress, threads)
        valid = valid_strokes(ground, np.array([one.frequency for one in chart.columns]), strokes, whole)
        found = None
        if areas:
            with progress(AREAS):
                found = interruptible(_areas, ground, whole, shortest, factors, across)
        (path,) = ground.paths([(1.0, 1.0)], threads)
        moves = any(one.lost > one.slips * 1.01 for one in chart.columns)
        near = None if moves else nearest(ground, chart)
    lost = path.outcome in borders.LOST
    own: State = "lost" if lost else "moves" if path.path_length > 0 else "rest"
    return Feasibility(case, own, chart, valid, near, found, frequency, stroke, unit, whole, ground)


def _chart(
    ground: Ground, factors: FloatArray, strokes: tuple[float, float], progress: Progress, threads: int | None
) -> Chart:
    """The chart; the case's own frequency is one of its columns, where it lies between the others."""
    slow = not (ground.follows and ground.linear)
    count, most = (FEW_COLUMNS, MAX_FEW) if slow else (COLUMNS, MAX_COLUMNS)
    first, last = float(factors[0]), float(factors[-1])
    if first < 1 < last:
        below = max(round((count - 1) * math.log(1 / first) / math.log(last / first)), 1)
        columns = [*np.geomspace(first, 1.0, below + 1).tolist(), *np.geomspace(1.0, last, max(count - below, 2))[1:]]
    else:
        columns = np.geomspace(first, last, count).tolist()

    def find(frequency: float, beside: Sequence[Column]) -> Column:
        return find_column(ground, float(frequency), strokes, beside, threads)

    with progress(BORDERS) as tell:
        return make_chart(find, columns, strokes, most, tell)


def _areas(ground: Ground, whole: float, stroke_time: float, factors: FloatArray, across: int) -> Feasible:
    """The areas over a window [s]; a plate with mass is driven anew at each factor."""
    case, part = ground.case, build_part(ground.case)
    rest = case.run.gravity, across, case.run.after_tipping == "stop"
    if ground.follows:
        surface = ground.driven(1.0, 1.0)
        return find_feasible(surface, ground.outline, part, ground.friction, whole, factors, *rest)
    model = getattr(ground.surface, "model", None)
    assert isinstance(model, (VibrationModel, RingingModel))
    place = Place(ground.outline, part, ground.friction, *rest)
    return find_feasible_anew(
        lambda factor, end: ground.driven(factor, 1.0, end), model.chosen.modes.frequencies, stroke_time, place, whole,
        factors,
    )  # fmt: skip
