"""Runs: a period of the drives from rest at places all over a plate, by groups of actuators, and some longer ones."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from contextlib import nullcontext
from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.interpolate import LinearNDInterpolator

from active_surface.arrays import BoolArray, FloatArray, IntArray
from active_surface.studies.drifts.basins import STILL, Fate, Field
from active_surface.studies.drifts.maps import SLIDING, Check, DriftMap
from active_surface.studies.drifts.result import Drift
from active_surface.studies.feasibility import moving, on_plate, responses_of, resting_of, squares_within
from active_surface.studies.feasibility.counting import HANGS, RESTS, find_states
from coupling import (
    PathTask,
    Progress,
    ProgressCallback,
    SolvedPlates,
    borders,
    build_drives,
    build_friction,
    build_part,
    follow,
    no_progress,
    one_blas_thread,
    silent,
)
from coupling.case import Case, PlateCase, endless_case, groups_of, running_case
from coupling.scene import PlateScene
from coupling.stretch import schedule_of
from coupling.vibration import always_running
from particle import Outcome, PartAtRest, State, Trajectory
from particle.drives import drive_table
from particle.friction import LOCAL, Contact, ScaledFriction

ACROSS: Final = 32  # places along the plate's longer side
STAGES: Final = 3  # of progress, for each group
LOOSE: Final = 1e-6  # the tolerance of the paths, unless that of the case is larger
PER_STROKE: Final = 10  # moments in the shortest stroke, at which a part at rest is looked at
SURE: Final = 0.8  # of the friction limit: a part that is pulled less at these moments never slips
CHECKED: Final = 8  # runs that a map is compared with
MOST: Final = 40  # periods of each
SEED: Final = 1
LATER: Final = 2  # periods that are followed, too, where more than SLIDING still move when the first ends
ROUNDING: Final = 1e-9  # of the time


def drift(
    case: Case,
    groups: str | Mapping[str, Sequence[int]] = "all",
    across: int = ACROSS,
    threads: int | None = None,
    progress: Progress = silent,
    plates: SolvedPlates | None = None,
) -> Drift:
    """Find where the drives of a case carry its part in a period, from rest at places all over the plate.

    The drives have always been running, whatever their delays, numbers of cycles and ramps. Where a period carries a
    part from rest to rest, many periods are that map again and again, and `Basins` follows it to where parts end.
    Where more than 5 % still move when the period ends, that of the three first periods is taken by which 16 runs end
    nearest to where the map says. How far 8 others end from there is measured, as long as the case's run, at most 40
    periods.

    Parameters
    ----------
    case : Case
        A case with a plate, whose drives have a common period. Its part's place and velocity do not matter.
    groups : str or mapping
        `"all"` actuators, or each of the `"columns"`, `"rows"` or actuators (`"each"`) alone, the others holding the
        plate where it is; or the numbers of the actuators by the groups' names. Groups at rest are left out.
    across : int
        Places along the plate's longer side.
    threads : int, optional
        Paths at a time, by default one a processor.
    progress : Progress
        Reports the progress of a stage.
    plates : SolvedPlates, optional
        Plates that are solved already, and where this one is kept.

    Returns
    -------
    drift : Drift
        One map for each group.

    Raises
    ------
    ValueError
        The case has a platform, a film of air, or drives that do not move, do not come back or have no common period,
        or its part has no room on the plate.
    """
    running = running_groups(case, groups)
    plates, case = plates or SolvedPlates(), endless_case(case)
    with one_blas_thread():
        maps = [
            _map(running_case(case, numbers), name, across, threads, progress, plates)
            for name, numbers in running.items()
        ]
    return Drift(case, tuple(maps))


def running_groups(case: Case, groups: str | Mapping[str, Sequence[int]]) -> dict[str, tuple[int, ...]]:
    """The numbers of the actuators of each group that moves, as of `drift`, which raises likewise."""
    if not isinstance(case.plate, PlateCase):
        raise ValueError("Input case of drift must have a plate: on a platform a part drifts everywhere alike")
    if case.air is not None and case.air.film:
        raise ValueError("Input case of drift must not have a film of air, which remembers the periods before")
    chosen = groups_of(case, groups) if isinstance(groups, str) else {name: tuple(one) for name, one in groups.items()}
    moves = {k for k, drive in enumerate(build_drives(case)) if drive.segments().coefficients[:, 1:].any()}
    running = {name: numbers for name, numbers in chosen.items() if not moves.isdisjoint(numbers)}
    if not running:
        raise ValueError("Input case of drift must have drives that move; all strokes and forces are 0")
    return running


def _map(
    case: Case,
    name: str,
    across: int,
    threads: int | None,
    progress: Progress,
    plates: SolvedPlates,
) -> DriftMap:
    """The map of a case whose drives have no end."""
    drives = [always_running(one) for one in build_drives(case)]
    schedule, running = schedule_of(drives, math.inf), np.flatnonzero(moving(drive_table(drives))).tolist()
    if schedule.loop < 0:
        raise ValueError("Input case of drift must have drives with a common period: frequencies in whole ratios")
    period = float(schedule.edges[-1] - schedule.edges[schedule.loop])
    with progress(f"Moving the plate, {name}") as tell:
        ground = _ground(case, period, threads, plates, lambda _: nullcontext(tell))
    outline = ground.scene.shapes.outline
    squares = squares_within(outline, across, ground.resting(ground.law))
    starts = squares.centres
    with progress(f"Following parts, {name}") as tell:
        slips = np.flatnonzero(~ground.never_slips(starts))
        paths = ground.follow(starts[slips], 1, tell)
        moves = [_fate(path) == Fate.MOVES and path.state[-1] != State.STICK for path in paths]
        sliding, after = sum(moves) / len(starts), 0
        if sliding > SLIDING:
            paths, after = ground.follow(starts[slips], 1 + LATER, tell), LATER
    found = [_displaced(starts, squares.side, slips, paths, period, k) for k in range(after + 1)]
    with progress(f"Comparing runs, {name}") as tell:
        after, check = _checked(ground, [field for field, _ in found], starts, round(case.run.duration / period), tell)
    field, turned = found[after]
    places = ground.scene.shapes.points
    return DriftMap(name, tuple(running), period, after, field, starts, turned, sliding, check, outline, places)


def _displaced(
    starts: FloatArray, spacing: float, slips: IntArray, paths: Sequence[Trajectory], period: float, after: int
) -> tuple[Field, FloatArray]:
    """The displacement in a period after others from rest, and the turn (n,) [rad], by paths from the starts `slips`.

    Such a period begins elsewhere: what it does at the starts follows linearly from what it does there.
    """
    n = len(starts)
    moved, turned, fates, places = np.zeros((n, 2)), np.zeros(n), np.zeros(n, dtype=np.int64), starts.copy()
    ends = period * np.array([after, after + 1.0])
    for k, path in zip(slips.tolist(), paths, strict=True):
        fates[k] = Fate.MOVES if path.time[-1] >= ends[1] * (1 - ROUNDING) else _fate(path)
        if fates[k] == Fate.MOVES:
            at = path.at(np.minimum(ends, path.time[-1]))
            places[k], moved[k] = at.position[0], at.position[1] - at.position[0]
            turned[k] = 0.0 if at.heading is None else at.heading[1] - at.heading[0]
    kept, moves = fates <= Fate.MOVES, fates == Fate.MOVES
    if after and moves.any():
        own = LinearNDInterpolator(places[kept], np.column_stack([moved, turned])[kept])(starts)
        there = moves & ~np.isnan(own[:, 0])
        moved[there], turned[there] = own[there, :2], own[there, 2]
    fates[moves & (np.hypot(*moved.T) < STILL * spacing)] = Fate.STAYS
    moved[fates == Fate.STAYS] = 0.0
    return Field.of(starts, spacing, moved, fates), turned


@dataclass(frozen=True, eq=False)
class _Ground:
    """What parts are followed over."""

    case: Case  # whose run is one period
    scene: PlateScene
    law: Contact
    threads: int | None

    def resting(self, law: Contact) -> PartAtRest:
        """The part at rest under a friction law."""
        return borders.at_rest(self.case, self.scene.surface, build_part(self.case), law)

    def follow(self, places: FloatArray, periods: int, tell: ProgressCallback = no_progress) -> list[Trajectory]:
        """The paths from rest at places (k, 2) [m], over so many periods."""
        run = self.case.run.model_copy(update={"duration": periods * self.case.run.duration})
        parts = [build_part(self.case, (x, y)) for x, y in places.tolist()]
        return follow([PathTask(self.scene.surface, part, self.law, run) for part in parts], self.threads, tell)

    def never_slips(self, places: FloatArray) -> BoolArray:
        """Whether a part at rest is pulled by less than SURE of what friction holds, at places (n, 2) [m].

        At as many moments as show the shortest stroke; False: not known, as where the plate rings or contact is local.
        """
        surface, weaker = self.scene.surface, self.resting(ScaledFriction(self.law, SURE))
        if self.scene.has_inertia or weaker.part.law.kind == LOCAL:
            return np.zeros(len(places), dtype=np.bool_)
        period = self.case.run.duration
        stroke = float(surface.drives.stroke_time[moving(surface.drives)].min(initial=period))
        moments = np.linspace(0.0, period, math.ceil(PER_STROKE * period / stroke) + 1)
        still, states = np.ones(len(places), dtype=np.bool_), np.zeros((len(places), 1), dtype=np.int8)
        resting = resting_of(weaker)
        for responses in responses_of(weaker, places, moments)():
            find_states(responses, np.ones(1), weaker.part, resting, states)
            still &= (states[:, 0] == RESTS) | (states[:, 0] == HANGS)
        return still


def _ground(case: Case, period: float, threads: int | None, plates: SolvedPlates, progress: Progress) -> _Ground:
    update = {"duration": period, "start": "steady", "tolerance": max(case.run.tolerance, LOOSE)}
    run = case.run.model_copy(update=update)
    still = case.part.model_copy(update={"velocity": (0.0, 0.0), "spin": 0.0})
    case = case.model_copy(update={"run": run, "part": still})
    scene = plates.scene(case, progress)
    assert isinstance(scene, PlateScene)
    return _Ground(case, scene, build_friction(case), threads)


def _checked(
    ground: _Ground, fields: Sequence[Field], starts: FloatArray, periods: int, tell: ProgressCallback
) -> tuple[int, Check]:
    """Which of fields tells best where runs end from random places within squares that move, and how others compare."""
    chance = np.random.default_rng(SEED)
    movers = starts[fields[0].fates == Fate.MOVES]
    places = chance.permutation(movers) + fields[0].spacing * chance.uniform(-0.5, 0.5, movers.shape)
    places = places[on_plate(ground.scene.shapes.outline, places, ground.resting(ground.law))]
    places = places[: CHECKED if len(fields) == 1 else 3 * CHECKED]
    if not len(places):
        return 0, Check()
    periods = min(max(periods, 1), MOST)
    paths, best = ground.follow(places, periods, tell), 0
    if len(fields) > 1 and len(places) > 1:
        some = 2 * len(places) // 3  # the others then judge the field that is chosen by these
        trials = [_compared(field, places[:some], paths[:some], periods) for field in fields]
        best = int(np.argmin([(one.otherwise + 1) * (np.inf if np.isnan(one.gap) else one.gap) for one in trials]))
        places, paths = places[some:], paths[some:]
    return best, _compared(fields[best], places, paths, periods)


def _compared(field: Field, places: FloatArray, paths: Sequence[Trajectory], periods: int) -> Check:
    """How far runs from places (k, 2) [m] end from where a field carries parts."""
    ends, fates = field.carried(places, periods)
    theirs = np.array([path.position[-1] for path in paths])
    lost = np.array([_fate(path) > Fate.MOVES for path in paths])
    both = ~lost & (fates <= Fate.MOVES)
    otherwise = int((lost != (fates > Fate.MOVES)).sum())
    if not both.any():
        return Check(len(paths), periods, otherwise=otherwise)
    way, gap = (float(np.median(np.hypot(*(theirs - other)[both].T))) for other in (places, ends))
    return Check(len(paths), periods, way, gap, otherwise)


def _fate(path: Trajectory) -> Fate:
    if path.outcome is Outcome.LEFT_PLATE:
        return Fate.LEAVES
    return Fate.MOVES if path.outcome in borders.KEPT else Fate.COMES_OFF
