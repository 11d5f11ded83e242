"""Study: a base case, and the points around it whose paths are found."""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass
from typing import Any

from active_surface.studies.points import Points
from active_surface.studies.threshold import Threshold
from coupling import PACKAGES as SHARED
from coupling import versions as versions_of
from coupling.case import Case, lattice_of
from coupling.results import files_of

PACKAGES = (*SHARED, "active_surface/studies")
FILE_NAMES = {"mesh", "motion"}  # keys of a plate that may name a file; its content counts


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

    @property
    def traits(self) -> dict[str, str]:
        """Hashes of what its numbers depend on: case, the files that it reads, points and versions."""
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
        drawn = points.sampling in ("random", "sobol")
        seed = points.seed if drawn or points.jitter else None
        return [axes, points.sampling, points.count if drawn else None, points.repeats, points.jitter, seed]


def versions() -> dict[str, str]:
    """The versions of the code that finds a sweep's paths."""
    return versions_of(PACKAGES)


def _hash(value: Any) -> str:
    return hashlib.sha256(json.dumps(value, sort_keys=True).encode()).hexdigest()
