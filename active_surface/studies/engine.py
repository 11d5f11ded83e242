"""The engine: the records of a study's paths, in chunks of about a second of work.

A record depends on the study and the number of its path alone: neither on threads nor on other paths of its chunk.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from typing import Final, NamedTuple

import numpy as np
from threadpoolctl import threadpool_limits

from active_surface.arrays import IntArray
from active_surface.studies.heights import drive_sets, largest
from active_surface.studies.record import Records, new_records, put
from active_surface.studies.refusal import case_faults, contact_of, mistakes_of, start_faults
from active_surface.studies.study import Study
from active_surface.studies.variants import Base, Variants
from coupling import build_drives, build_part, shared_surface, silent
from coupling.case import Case, InputError, PlatformCase, RunCase
from coupling.scene import platform_scene
from particle import Micropart, SurfaceMotion, Trajectory, simulate_many
from particle.friction import Contact

AT_ONCE: Final = 1.0  # s, about, of work in a chunk
A_PATH, A_CYCLE = 4e-4, 3e-4  # s, about: of work for a path, and for each cycle of its fastest drive
A_PLATE, A_PLATFORM = 0.5, 2e-3  # s, about: of work for one of these
SURFACES: Final = 16  # kept at most: each takes some 5 MB
HELD: Final = 256  # trajectories in memory at a time: each takes 0.13 MB, however short
TOGETHER: Final = 64  # paths that `follow` computes side by side
FAILURES: Final = (ValueError, ArithmeticError, RuntimeError)


class _Path(NamedTuple):
    """A path to compute."""

    row: int
    case: Case
    part: Micropart
    friction: Contact


Visit = Callable[[int, Trajectory], object]  # is called with the number of a path and the path
_Group = tuple[list[_Path], SurfaceMotion, RunCase]


class Engine:
    """Computes the records of a study."""

    def __init__(self, study: Study, threads: int | None = None) -> None:
        self.study, self._threads = study, threads
        self.variants = Variants(study.case, study.points.axes)
        self._surfaces: dict[str, SurfaceMotion | str] = {}
        self._kept = min(self.variants.grounds(study.points), SURFACES)
        self._duration = max(largest(study.points, "run.duration"), default=study.case.run.duration)
        self.paths = len(study.points)
        self.chunk_length = self._chunk_length()

    def chunks(self, numbers: IntArray) -> list[IntArray]:
        """The ascending numbers of paths in chunks."""
        return [numbers[first : first + self.chunk_length] for first in range(0, len(numbers), self.chunk_length)]

    def _chunk_length(self) -> int:
        case, points = self.study.case, self.study.points
        if isinstance(case.plate, PlatformCase):
            scene = platform_scene(case.plate, silent)
            drives, base = [*scene.lifts, *scene.base], A_PLATFORM
        else:
            drives, base = build_drives(case), A_PLATE
        fastest = max((*(drive.frequency for drive in drives), *largest(points, "frequency")), default=0.0)
        each = A_PATH + A_CYCLE * self._duration * fastest + base / self.variants.paths_of_a_base(points)
        return max(int(AT_ONCE / each), 1)

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
            self._visit(every[first : first + TOGETHER], visit)

    def _visit(self, together: list[int], visit: Visit) -> None:
        """The same for numbers of paths that are computed side by side."""
        self._computed(together, lambda row, path: visit(together[row], path))

    def _computed(
        self, numbers: Sequence[int] | IntArray, visit: Visit | None = None
    ) -> tuple[Records, dict[int, list[str]]]:
        """The records, and by row what is wrong with the refused."""
        records = new_records(len(numbers))
        wrong: dict[int, list[str]] = {}
        # Many small systems: BLAS threads would only wait for each other.
        with threadpool_limits(limits=1, user_api="blas"):
            for paths, surface, run in self._groups(numbers, records, wrong):
                for first in range(0, len(paths), HELD):
                    self._follow(records, wrong, paths[first : first + HELD], surface, run, visit)
        for row, messages in wrong.items():
            records["mistakes"][row] = len(messages)
        return records, wrong

    def _groups(
        self, numbers: Sequence[int] | IntArray, records: Records, wrong: dict[int, list[str]]
    ) -> Iterator[_Group]:
        """Yield paths that can be computed side by side; note in `wrong` what is wrong with the others."""
        points = self.study.points
        displaced = points.displacements(numbers)
        grounds: dict[str, list[tuple[int, Case, Base]]] = defaultdict(list)
        for row, values in enumerate(points.values(numbers)):
            try:
                case, base = self.variants.at(values)
            except InputError as error:
                wrong[row] = mistakes_of(error)
            except ArithmeticError as error:
                wrong[row] = [f"its case cannot be made: {error}"]
            else:
                grounds[base.ground].append((row, case, base))
        for several in grounds.values():
            groups: dict[RunCase, list[_Path]] = defaultdict(list)
            surface = self._surface(several[0][2])
            starts = np.array([case.part.position for _, case, _ in several]) + displaced[[row for row, *_ in several]]
            faults = start_faults(several[0][2].case, starts)
            for (row, case, _), place, messages in zip(several, starts.tolist(), faults, strict=True):
                records["start_x"][row], records["start_y"][row] = place
                law = contact_of(case.friction)
                if faults_here := [*messages, *case_faults(case), *([surface] if isinstance(surface, str) else [])]:
                    wrong[row] = faults_here
                elif not isinstance(law, str):
                    part = build_part(case, (place[0], place[1]))
                    groups[case.run].append(_Path(row, case, part, law))
            if not isinstance(surface, str):
                yield from ((paths, surface, run) for run, paths in groups.items())

    def _follow(
        self,
        records: Records,
        wrong: dict[int, list[str]],
        paths: Sequence[_Path],
        surface: SurfaceMotion,
        run: RunCase,
        visit: Visit | None,
    ) -> None:
        try:
            trajectories = simulate_many(
                surface,
                [path.part for path in paths],
                [path.friction for path in paths],
                run.duration,
                run.gravity,
                run.tolerance,
                run.after_detachment,
                [build_drives(path.case) for path in paths] if self.variants.drives_vary else None,
                self._threads,
            )
        except FAILURES as error:
            if len(paths) == 1:
                wrong[paths[0].row] = [f"its path cannot be found: {error}"]
            else:
                for path in paths:
                    self._follow(records, wrong, [path], surface, run, visit)
        else:
            for path, trajectory in zip(paths, trajectories, strict=True):
                put(records, path.row, path.part.position, trajectory)
                if visit is not None:
                    visit(path.row, trajectory)

    def _surface(self, base: Base) -> SurfaceMotion | str:
        """The moving surface, or why there is none.

        It is made on this thread, which also drops those no longer kept: elsewhere their memory would leak.
        """
        if base.ground not in self._surfaces:
            if len(self._surfaces) == self._kept:
                del self._surfaces[next(iter(self._surfaces))]
            try:
                self._surfaces[base.ground] = shared_surface(
                    base.case, drive_sets(self.study, self.variants, base), self._duration
                )
            except FAILURES as error:
                self._surfaces[base.ground] = f"what the part moves over cannot be made: {error}"
        return self._surfaces[base.ground]
