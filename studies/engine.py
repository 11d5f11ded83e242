"""The engine: the records of a study's paths, a chunk of about a second of work at a time.

What a chunk is depends on the study alone, and its records on nothing but the study and the chunk's number: neither on
threads nor on which chunks came before.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Generator, Iterable, Sequence
from functools import lru_cache
from typing import Final, NamedTuple

import numpy as np
from pydantic import ValidationError
from threadpoolctl import threadpool_limits

from coupling.case import Case, RunCase
from coupling.drives import build_drives
from coupling.platform_case import PlatformCase
from coupling.platform_scene import platform_scene
from coupling.progress import interruptible, silent
from coupling.run import build_scene
from particle import Micropart, SurfaceMotion, simulate_many
from particle.friction import Contact
from studies.record import Records, new_records, put
from studies.refusal import contact_of, mistakes_of, start_faults
from studies.study import Study
from studies.variants import Base, Variants

AT_ONCE: Final = 1.0  # s, about, that a chunk takes
A_PATH, A_CYCLE = 4e-4, 3e-4  # s, about, that a path takes, and each cycle of its fastest drive
A_PLATE, A_PLATFORM = 0.5, 2e-3  # s, about, that these take
SURFACES: Final = 4  # kept
HELD: Final = 256  # trajectories in memory at a time: each takes 0.13 MB, however short


class _Path(NamedTuple):
    """A path that is to be found."""

    row: int
    case: Case
    part: Micropart
    friction: Contact


class Engine:
    """Finds the records of a study."""

    def __init__(self, study: Study, threads: int | None = None) -> None:
        self.study, self._threads = study, threads
        self.variants = Variants(study.case, study.points.axes)
        self._surfaces = lru_cache(SURFACES)(self._new_surface)
        self._bases: dict[str, Base] = {}
        self.paths = len(study.points)
        self.chunk_length = self._chunk_length()

    @property
    def chunks(self) -> int:
        """How many chunks there are."""
        return -(-self.paths // self.chunk_length)

    def span(self, chunk: int) -> tuple[int, int]:
        """The first path of a chunk, and the one after its last."""
        start = chunk * self.chunk_length
        return start, min(start + self.chunk_length, self.paths)

    def _chunk_length(self) -> int:
        case, points = self.study.case, self.study.points
        if isinstance(case.plate, PlatformCase):
            scene = platform_scene(case.plate, silent)
            drives, base = [*scene.lifts, *scene.base], A_PLATFORM
        else:
            drives, base = build_drives(case), A_PLATE
        fastest = max((drive.frequency for drive in drives), default=0.0)
        each = A_PATH + A_CYCLE * case.run.duration * fastest + base / self.variants.paths_of_a_base(points)
        return max(int(AT_ONCE / each), 1)

    def records_of(self, chunks: Iterable[int]) -> Generator[tuple[int, Records], None, None]:
        """Yield chunks and their records, one after the other."""
        for chunk in chunks:
            yield chunk, self.records(*self.span(chunk))

    def records(self, start: int, stop: int) -> Records:
        """The records of the paths from one to before another."""
        # Many small systems: BLAS threads would only wait for each other.
        with threadpool_limits(limits=1, user_api="blas"):
            return self._records(start, stop)

    def _records(self, start: int, stop: int) -> Records:
        points = self.study.points
        records = new_records(stop - start)
        displaced = points.displacements(start, stop)
        groups: dict[tuple[SurfaceMotion, RunCase], list[_Path]] = defaultdict(list)
        grounds: dict[str, list[tuple[int, Case, Base]]] = defaultdict(list)
        for row, values in enumerate(points.values(start, stop)):
            try:
                case, base = self.variants.at(values)
            except ValidationError as error:
                records["mistakes"][row] = len(mistakes_of(error))
            else:
                grounds[base.ground].append((row, case, base))
        for ground, several in grounds.items():
            self._bases = {ground: several[0][2]}
            surface = self._surfaces(ground)
            starts = np.array([case.part.position for _, case, _ in several]) + displaced[[row for row, *_ in several]]
            faults = start_faults(several[0][2].case, starts)
            for (row, case, _), place, wrong in zip(several, starts.tolist(), faults, strict=True):
                law = contact_of(case.friction)
                wrong += [said for said in (law, surface) if isinstance(said, str)]
                records["mistakes"][row] = len(wrong)
                if not wrong and not isinstance(law, str) and not isinstance(surface, str):
                    part = Micropart(case.part.mass, (place[0], place[1]), case.part.velocity, case.part.squeeze)
                    groups[surface, case.run].append(_Path(row, case, part, law))
        for (surface, run), paths in groups.items():
            for first in range(0, len(paths), HELD):
                self._follow(records, paths[first : first + HELD], surface, run)
        return records

    def _follow(self, records: Records, paths: Sequence[_Path], surface: SurfaceMotion, run: RunCase) -> None:
        parts = [path.part for path in paths]
        drives = [build_drives(path.case) for path in paths] if self.variants.drives_vary else None
        frictions = [path.friction for path in paths]
        found = simulate_many(
            surface,
            parts,
            frictions,
            run.duration,
            run.gravity,
            run.tolerance,
            run.after_detachment,
            drives,
            self._threads,
        )
        for path, trajectory in zip(paths, found, strict=True):
            put(records, path.row, path.part.position, trajectory)

    def _new_surface(self, ground: str) -> SurfaceMotion | str:
        """The moving surface, or why there is none."""
        try:
            return interruptible(build_scene, self._bases[ground].case).surface
        except (ValueError, RuntimeError) as error:
            return str(error)
