"""Study: a base case, and the points around it whose paths are found."""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass
from typing import Any

from active_surface.studies.points import Points
from active_surface.studies.threshold import Threshold
from active_surface.studies.variants import lattice_of
from coupling import PACKAGES as SHARED
from coupling import versions as versions_of
from coupling.case import Case
from coupling.results import files_of

PACKAGES = (*SHARED, "studies")


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
        """A hash of all that its results depend on."""
        return _hash(self.traits)

    @property
    def traits(self) -> dict[str, str]:
        """Hashes of what its results depend on: case, the files that it reads, points and versions."""
        return {
            "case": _hash([self.case.model_dump_json(exclude={"name", "source"}), lattice_of(self.case)]),
            "files of the case": _hash([hashlib.sha256(file).hexdigest() for file in files_of(self.case).values()]),
            "points": _hash(repr(self._plain_points())),
            "versions": _hash(versions()),
        }

    def _plain_points(self) -> list[Any]:
        points = self.points
        axes = [(a.name, a.field.path, a.values, a.low, a.high, a.logarithmic) for a in points.axes]
        return [axes, points.sampling, points.count, points.repeats, points.jitter, points.seed]


def versions() -> dict[str, str]:
    """The versions of what a sweep's paths are found by."""
    return versions_of(PACKAGES)


def _hash(said: Any) -> str:
    return hashlib.sha256(json.dumps(said, sort_keys=True).encode()).hexdigest()
