"""Study: a base case, the points around it whose paths are found, the case at each, and why one is refused."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final

from active_surface.arrays import FloatArray
from active_surface.studies.axes import Axis
from active_surface.studies.columns import Threshold
from active_surface.studies.points import Points
from coupling import PACKAGES as SHARED
from coupling import answers_drives, build_drives, build_friction
from coupling import versions as versions_of
from coupling.case import (
    Case,
    InputError,
    PlateCase,
    PlatformCase,
    gaps,
    lattice_of,
    must_be_inside,
)
from coupling.results import files_of
from particle import AnyDrive
from particle.friction import Contact

PACKAGES: Final = (*SHARED, "active_surface/studies")
FILE_NAMES: Final = {"mesh", "motion"}  # keys of a plate that may name a file; its content counts
OF_PLATE: Final = ("position", "stiffness")
"""Keys of an actuator that change the plate's shapes."""
DEEP_OF_RUN: Final = (("run", "surface_tolerance"), ("run", "start"))
"""Keys of the run that change the surface."""
THEORIES: Final = ("plate.theory", "plate.inertia")
"""Fields that decide whether a plate answers its drives."""


@dataclass(frozen=True)
class Study:
    """What one sweep does; `name` is the stem of the file it was read from, and `source` the text of that file."""

    case: Case
    points: Points
    name: str = "study"
    source: str = ""
    threshold: Threshold | None = None  # of its picture

    @property
    def key(self) -> str:
        """A hash of all that its numbers depend on; labels, titles and what is drawn are no part of it."""
        return _hash(self.traits)

    @cached_property
    def traits(self) -> dict[str, str]:
        """Hashes of what its numbers depend on: case, the files that it reads, points and versions.

        Found once, as pydantic drops a Ctrl-C that arrives while it writes a case.
        """
        return {
            "case": _hash(self._case_numbers()),
            "files of the case": _hash([hashlib.sha256(file).hexdigest() for file in files_of(self.case).values()]),
            "points": _hash(repr(self._point_numbers())),
            "versions": _hash(versions()),
        }

    def _case_numbers(self) -> list[Any]:
        """The tables of the case without the names of its files, and the lattice, which an axis may vary."""
        tables = self.case.model_dump(mode="json", exclude={"name", "source"})
        del tables["run"]["frames"]
        for key in FILE_NAMES & tables["plate"].keys():
            if isinstance(tables["plate"][key], str):
                del tables["plate"][key]
        return [tables, lattice_of(self.case)]

    def _point_numbers(self) -> list[Any]:
        """What the points follow from; the seed counts only where something is drawn."""
        points = self.points
        axes = [(a.field.path, a.values or (a.low, a.high, a.logarithmic)) for a in points.axes]
        return [axes, points.sampling, points.count if points.drawn else None, points.repeats, *points.stream]

    @property
    def heights(self) -> str:
        """A hash of what all paths share beyond the case and their own values; "": they share nothing."""
        theories = any(axis.field.path in THEORIES for axis in self.points.axes)
        if not answers_drives(self.case) and not theories:
            return ""
        samples: list[Any] = []
        if self.drives_vary:
            fields = [axis.field.path for axis in self.points.axes]
            samples = [sorted(zip(fields, values, strict=True)) for values in self.points.samples()]
        return hashlib.sha256(repr((self.duration, samples)).encode()).hexdigest()

    @property
    def duration(self) -> float:
        """The duration [s] of the longest run."""
        return max(self.points.largest("run.duration"), default=self.case.run.duration)

    @property
    def drives_vary(self) -> bool:
        """Whether an axis changes drives of actuators."""
        return any(axis.field.locations[0][0] in ("actuators", "lattice") for axis in self.points.axes)

    def drive_sets(self, case: Case) -> list[list[AnyDrive]]:
        """Drives that stand for those of all paths over the plate of a case of the study, which answers them."""
        own = build_drives(case)
        if not self.drives_vary:
            return [own]
        sets = []
        for values in self.points.samples():
            with suppress(InputError, ArithmeticError):
                sample = self.case_at(values)
                sets += [build_drives(sample)] if len(sample.actuators) == len(own) else []
        return sets or [own]

    def case_at(self, values: Sequence[Any]) -> Case:
        """The case at a point, by the values of its axes; raises InputError when there is none."""
        return self.case.vary(dict(zip((axis.field.path for axis in self.points.axes), values, strict=True)))

    def case_or_faults(self, values: Sequence[Any]) -> Case | list[str]:
        """The case at a point, by the values of its axes, or why there is none."""
        try:
            return self.case_at(values)
        except InputError as error:
            return [f"{field} {message}" for field, message in error.problems]
        except ArithmeticError as error:
            return [f"its case cannot be made: {error}"]

    def refusals(self, k: int) -> list[str]:
        """What is wrong with the case and the start of path k; nothing: it can be run."""
        case = self.case_or_faults(self.points.values([k])[0])
        if isinstance(case, list):
            return case
        law = contact_of(case)
        (faults,) = start_faults(case, self.points.displacements([k]) + case.part.position)
        return [*faults, law] if isinstance(law, str) else faults


def versions() -> dict[str, str]:
    """The versions of the code that finds a sweep's paths."""
    return versions_of(PACKAGES)


def is_deep(case: Case, axis: Axis) -> bool:
    """Whether an axis changes what the part moves over."""
    first = axis.field.locations[0]
    if first[0] == "actuators":
        return first[2] in OF_PLATE
    on_platform = isinstance(case.plate, PlatformCase) and first == ("run", "duration")  # a measured motion has an end
    return first[0] in ("plate", "lattice") or first in DEEP_OF_RUN or on_platform


def contact_of(case: Case) -> Contact | str:
    """The friction law of a case, or what is wrong with it."""
    try:
        law = build_friction(case)
        law.law  # noqa: B018  # made when it is first asked for
    except (ValueError, ArithmeticError) as error:
        return str(error)
    return law


def start_faults(case: Case, starts: FloatArray) -> list[list[str]]:
    """For each start (n, 2) [m] what is wrong with it; nothing: it is on the plate, which a face may yet overhang."""
    if not isinstance(case.plate, PlateCase):
        return [[] for _ in starts]
    mesh = case.plate.coarse_mesh
    return [
        [] if gap > mesh.least_gap else [f"part.position {must_be_inside(gap, mesh)}"]
        for gap in gaps(mesh, [(x, y) for x, y in starts.tolist()])
    ]


def _hash(value: Any) -> str:
    return hashlib.sha256(json.dumps(value, sort_keys=True).encode()).hexdigest()
