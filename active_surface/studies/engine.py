"""The engine: the records of a study's paths, in chunks of about a second of work.

A record depends on the study and the number of its path alone: neither on threads nor on other paths of its chunk.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Callable, Generator, Iterable, Sequence
from functools import partial
from typing import Final

import numpy as np

from active_surface.arrays import FloatArray, IntArray
from active_surface.studies.columns import Records, new_records, put
from active_surface.studies.study import Study, contact_of, is_deep, start_faults
from coupling import (
    FAILURES,
    PathTask,
    SolvedPlates,
    build_drives,
    build_part,
    follow_each,
    ground_key,
    one_blas_thread,
    silent,
)
from coupling.case import Case, PlatformCase
from coupling.scene import Scene, platform_scene
from particle import SurfaceMotion, Trajectory

AT_ONCE: Final = 1.0  # s, about, of work in a chunk
A_PATH, A_CYCLE = 4e-4, 3e-4  # s, about: of work for a path, and for each cycle of its fastest drive
A_PLATE, A_PLATFORM = 0.5, 2e-3  # s, about: of work for one of these
SURFACES: Final = 16  # kept at most: each takes some 5 MB
TOGETHER: Final = 64  # paths that `follow` computes side by side

Visit = Callable[[int, Trajectory], object]  # is called with the number of a path and the path


class Engine:
    """Computes the records of a study."""

    def __init__(self, study: Study, threads: int | None = None) -> None:
        self.study, self._threads = study, threads
        self._deep = [axis for axis in study.points.axes if is_deep(study.case, axis)]
        self._plates = SolvedPlates(keep=min(self._plates_at_a_time(), SURFACES))
        self._failed: dict[str, str] = {}  # why there is nothing to move over
        self._duration = study.duration
        self.paths = len(study.points)
        self.chunk_length = self._chunk_length()

    def chunks(self, numbers: IntArray) -> list[IntArray]:
        """The ascending numbers of paths in chunks."""
        return [numbers[first : first + self.chunk_length] for first in range(0, len(numbers), self.chunk_length)]

    def _chunk_length(self) -> int:
        case, points = self.study.case, self.study.points
        if isinstance(case.plate, PlatformCase):
            scene = platform_scene(case.plate, silent)
            drives, plate = [*scene.lifts, *scene.base], A_PLATFORM
        else:
            drives, plate = build_drives(case), A_PLATE
        fastest = max((*(drive.frequency for drive in drives), *points.largest("frequency")), default=0.0)
        each = A_PATH + A_CYCLE * self._duration * fastest + plate / self._paths_of_a_plate()
        return max(int(AT_ONCE / each), 1)

    def _paths_of_a_plate(self) -> int:
        """How many paths that follow each other share what they move over, about."""
        points = self.study.points
        if not self._deep:
            return len(points)
        shared = [len(axis.values) for axis in points.axes if axis not in self._deep]
        return points.repeats * (math.prod(shared) if points.sampling == "grid" else 1)

    def _plates_at_a_time(self) -> int:
        """How many different things to move over are to be kept at a time so that none is made twice."""
        listed = [len(axis.values) for axis in self._deep]
        return 1 if self.study.points.sampling == "grid" or 0 in listed else math.prod(listed)

    def records_of(self, chunks: Iterable[IntArray]) -> Generator[tuple[IntArray, Records], None, None]:
        """Yield chunks and their records, one after the other."""
        for chunk in chunks:
            yield chunk, self.records(chunk)

    def records(self, numbers: Sequence[int] | IntArray) -> Records:
        """The records of paths of these numbers."""
        return self._computed(numbers)[0]

    def faults(self, k: int) -> list[str]:
        """Why path k was refused, computed anew; empty: it was not."""
        return self._computed([k])[1].get(0, [])

    def follow(self, numbers: Iterable[int], visit: Visit) -> None:
        """Compute the paths of these ascending numbers again and visit each but the refused, with its number."""
        every = list(numbers)
        for first in range(0, len(every), TOGETHER):
            together = every[first : first + TOGETHER]
            self._computed(together, lambda row, path, together=together: visit(together[row], path))  # type: ignore[misc]

    def scene(self, case: Case) -> Scene:
        """The scene of a case of the study, over the surface that its paths share; raises as `SolvedPlates` does."""
        return self._plates.scene_among(case, partial(self.study.drive_sets, case), self._duration)

    def _computed(
        self, numbers: Sequence[int] | IntArray, visit: Visit | None = None
    ) -> tuple[Records, dict[int, list[str]]]:
        """The records, and by row what is wrong with the refused."""
        records = new_records(len(numbers))
        wrong: dict[int, list[str]] = {}
        points, grounds = self.study.points, defaultdict[str, list[tuple[int, Case]]](list)
        displaced = points.displacements(numbers)
        for row, values in enumerate(points.values(numbers)):
            case = self.study.case_or_faults(values)
            if isinstance(case, list):
                wrong[row] = case
            else:
                grounds[ground_key(case)].append((row, case))
        with one_blas_thread():
            for ground, pairs in grounds.items():
                rows, tasks = self._tasks(ground, pairs, displaced[[row for row, _ in pairs]], records, wrong)
                for number, path in follow_each(tasks, self._threads):
                    if isinstance(path, Exception):
                        wrong[rows[number]] = [f"its path cannot be found: {path}"]
                        continue
                    put(records, rows[number], tasks[number].part.position, path)
                    if visit is not None:
                        visit(rows[number], path)
        for row, messages in wrong.items():
            records["mistakes"][row] = len(messages)
        return records, wrong

    def _tasks(
        self,
        ground: str,
        pairs: Sequence[tuple[int, Case]],
        displaced: FloatArray,
        records: Records,
        wrong: dict[int, list[str]],
    ) -> tuple[list[int], list[PathTask]]:
        """The rows and paths of cases over the same ground; notes their starts, and in `wrong` why one is refused."""
        first, vary = pairs[0][1], self.study.drives_vary
        surface = self._surface(ground, first)
        starts = np.array([case.part.position for _, case in pairs]) + displaced
        rows, tasks = [], []
        for (row, case), place, messages in zip(pairs, starts.tolist(), start_faults(first, starts), strict=True):
            records["start_x"][row], records["start_y"][row] = place
            law = contact_of(case)
            if isinstance(law, str) or isinstance(surface, str) or messages:
                wrong[row] = [*messages, *(one for one in (law, surface) if isinstance(one, str))]
            else:
                part, drives = build_part(case, (place[0], place[1])), build_drives(case) if vary else None
                rows.append(row)
                tasks.append(PathTask(surface, part, law, case.run, drives))
        return rows, tasks

    def _surface(self, ground: str, case: Case) -> SurfaceMotion | str:
        """The moving surface, or why there is none.

        It is made on this thread, which also drops those no longer kept: elsewhere their memory would leak.
        """
        if ground not in self._failed:
            try:
                return self._plates.surface(case, partial(self.study.drive_sets, case), self._duration)
            except FAILURES as error:
                self._failed[ground] = f"what the part moves over cannot be made: {error}"
        return self._failed[ground]
