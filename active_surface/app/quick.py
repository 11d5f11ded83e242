"""Quick paths: what is drawn while a field is dragged, exact where that is fast, else coarser, or an estimate."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from functools import partial
from typing import Final

import numpy as np

from active_surface.app.leaps import leaped
from coupling import Progress, SolvedPlates, answers_drives, build_friction, follow_part
from coupling.case import Case, PlateCase, scaled_case
from coupling.scene import lifts_of
from particle import AnyDrive, Stopped, SurfaceMotion, Trajectory, stoppable

LIMIT: Final = 0.02  # s after which a path is broken off, and a coarser one is tried in its place
LEAPING: Final = 0.25  # s, the same of a path with leaps
SLOW: Final = 3  # of these in a row are broken off: no more are tried until nothing is dragged
LOOSE: Final = 1e-6  # the tolerance of coarser steps
LEVELS, LEAPS, SHORTER = 9, 2, 4  # of coarseness: exact, with coarse steps, leaps, then each time so many times shorter
CELLS: Final = 3.0  # of a coarse plate across its radius or half of its longer side
COARSE: Final = 1e-4  # the surface's tolerance there
MOMENT: Final = 1e-9  # s: its path has the cell at the start fitted, which may take longer than LIMIT
MAX_ACTUATORS: Final = 60  # of a plate that is solved coarsely while something is dragged
ROOM: Final = (0.5, 1.25)  # of the strokes: those that a model of a plate that stretches is made for

LINEAR: Final = "linear theory without inertia"
PLATE: Final = "a coarse plate"


@dataclass(frozen=True, eq=False)
class Quick:
    """A path, and in which way it is coarser than that of a run; nothing: it is the same."""

    path: Trajectory
    coarse: tuple[str, ...] = ()
    error: float | None = None  # m, of the end of one that is estimated


class QuickPaths:
    """Finds paths fast, over plates that are known or solved coarsely."""

    def __init__(self, plates: SolvedPlates) -> None:
        self._plates = plates
        self._coarse = SolvedPlates(keep=4)
        self._level: dict[int, int] = {}  # of coarseness that was quick enough, by the number of actuators
        self._slow = 0  # paths with leaps that were broken off one after the other

    def of(self, case: Case, rest: bool = True) -> Quick | None:
        """The path of a case; None where nothing quick is known, as for a thousand actuators on another plate.

        rest: whether nothing is dragged: so exact paths are tried first again.
        Raises ValueError where the case cannot be run.
        """
        surface, how = self._surface(case)
        if surface is None:
            return None
        law, exact, count = build_friction(case), case.run.tolerance, len(case.actuators)
        moment = case.run.model_copy(update={"duration": MOMENT})
        follow_part(case.model_copy(update={"run": moment}), surface, law)
        known = 0 if rest else self._level.get(count, 0)
        self._slow *= not rest
        leaping = {min(known, LEAPS)} if self._slow < SLOW else set()  # also where a path was broken off before
        for level in sorted({*range(known, LEVELS), *leaping}):
            coarse, self._level[count] = [how] if how else [], level
            if level == LEAPS:
                self._slow += 1
                with suppress(Stopped), _limited(LEAPING):
                    found, self._slow = leaped(case, surface, law), 0
                    if found is not None:
                        coarse.append(f"an estimate by {found.followed} of {found.periods} periods")
                        return Quick(found.path, tuple(coarse), found.error)
                continue
            tolerance, duration = exact, case.run.duration
            if level > 0:
                tolerance = max(exact, LOOSE)
                coarse.append(f"steps to {tolerance:g}")
            if level > LEAPS:
                duration /= SHORTER ** (level - LEAPS)
                coarse.append(f"only its first {duration * 1e3:.3g} ms")
            run = case.run.model_copy(update={"tolerance": tolerance, "duration": duration})
            with suppress(Stopped), _limited(LIMIT):
                return Quick(follow_part(case.model_copy(update={"run": run}), surface, law), tuple(coarse))
        return None

    def prepare(self, case: Case, progress: Progress) -> None:
        """Make the model that quick paths over a plate that stretches or vibrates take, unless it is there."""
        if answers_drives(case):
            self._plates.surface(case, partial(_room_of, case), case.run.duration, progress)

    def _surface(self, case: Case) -> tuple[SurfaceMotion | None, str]:
        """A surface for a case, and what is coarse about it."""
        if not answers_drives(case):
            return self._bending(case)
        if (model := self._plates.known_surface(case, case.run.duration)) is not None:
            try:
                return model.driven_by(lifts_of(case)), "a model made for these strokes"
            except ValueError:  # other strokes than the model is made for
                pass
        linear = _plate_with(case, theory="linear", in_plane_supports="immovable", inertia=False)
        run = case.run.model_copy(update={"start": "rest"})
        surface, how = self._bending(linear.model_copy(update={"run": run}))
        return surface, " over ".join([LINEAR, *([how] if how else [])])

    def _bending(self, case: Case) -> tuple[SurfaceMotion | None, str]:
        """A surface for a case whose plate only bends, and what is coarse about it."""
        if not isinstance(case.plate, PlateCase) or self._plates.knows(case):
            return self._plates.scene(case).surface, ""
        if len(case.actuators) > MAX_ACTUATORS or "cell_size" not in type(case.plate).model_fields:
            return None, ""  # a mesh from a file has the cells that it has
        size = float(np.ptp(case.plate.coarse_mesh.outline.box, axis=0).max()) / 2
        coarse = _plate_with(case, cell_size=size / CELLS)
        run = case.run.model_copy(update={"surface_tolerance": COARSE})
        return self._coarse.scene(coarse.model_copy(update={"run": run})).surface, PLATE


@contextmanager
def _limited(limit: float) -> Iterator[None]:
    """Breaks paths in its block off after a time [s], with Stopped."""
    stop = np.zeros(1, dtype=np.int64)
    timer = threading.Timer(limit, stop.__setitem__, (0, 1))
    timer.daemon = True
    timer.start()
    try:
        with stoppable(stop):
            yield
    finally:
        timer.cancel()


def _room_of(case: Case) -> list[list[AnyDrive]]:
    """The drives that a model of a plate that answers them is made for."""
    return [lifts_of(scaled_case(case, 1.0, room)) for room in ROOM]


def _plate_with(case: Case, **changes: object) -> Case:
    """The case with other values in its plate's table."""
    return case.model_copy(update={"plate": case.plate.model_copy(update=changes)})
