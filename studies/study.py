"""Study: a base case, and the points around it whose paths are found."""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any

from coupling.case import Case
from coupling.plate_case import MeshCase
from coupling.platform_case import PlatformCase
from studies.points import Points
from studies.threshold import Threshold
from studies.variants import lattice_of

VERSIONS = ("active-surface", "numpy", "scipy", "numba")


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
        """A hash of all that its results depend on: case, the files that it reads, points and versions."""
        said = {
            "case": self.case.model_dump_json(exclude={"name", "source"}),
            "lattice": lattice_of(self.case),
            "files": [hashlib.sha256(file.read_bytes()).hexdigest() for file in _files(self.case)],
            "points": repr(self._plain_points()),
            "versions": versions(),
        }
        return hashlib.sha256(json.dumps(said, sort_keys=True).encode()).hexdigest()

    def _plain_points(self) -> list[Any]:
        points = self.points
        axes = [(a.name, a.field.path, a.values, a.low, a.high, a.logarithmic) for a in points.axes]
        return [axes, points.sampling, points.count, points.repeats, points.jitter, points.seed]


def versions() -> dict[str, str]:
    """The versions of what a path is found by."""
    return {name: version(name) for name in VERSIONS}


def _files(case: Case) -> list[Path]:
    """The files that a case reads when its scene is built."""
    plate = case.plate
    if isinstance(plate, MeshCase):
        return [Path(plate.mesh)]
    return [Path(plate.motion)] if isinstance(plate, PlatformCase) and isinstance(plate.motion, str) else []
