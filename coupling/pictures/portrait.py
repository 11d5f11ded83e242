"""Portrait: what pictures show of a run, whether it has just ended or is read from its files."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from coupling.display import most_deflected, moving_heights
from coupling.pictures.plate import Relief, relief_of
from meshes import unit_for
from particle import AnyDrive, Event, Rows, Samples, Trajectory

if TYPE_CHECKING:
    from coupling.display import DisplaySurface
    from coupling.scene import Scene

FloatArray = NDArray[np.float64]

SAMPLES = 4000
BATCH = 64  # times whose deflections are computed together


@dataclass(frozen=True, eq=False)
class Portrait:
    """A run as pictures show it."""

    name: str
    sentence: str  # how it ended
    origin: str  # what positions are counted from
    rows: Rows  # where states change, among others
    samples: Samples  # as many as make smooth lines
    events: Sequence[Event]
    box: FloatArray  # (2, 2) m, around the surface as drawn
    relief: Relief | None  # of the plate at the moment; None: there is a platform
    moment: float  # s
    base: Sequence[AnyDrive]  # of a platform, along x and y; none: the surface stays in its plane
    complete: bool = True  # whether the files hold the run to its end

    @property
    def when(self) -> str:
        """The moment, with its unit."""
        unit = unit_for(self.samples.time[-1], "s")
        return f"{self.moment * unit.per_si:.4g} {unit.name}"

    @property
    def where(self) -> str:
        """What positions are counted from, where it is not the plate."""
        return f" on {self.origin}" if self.base else ""

    @property
    def most(self) -> str:
        """Why the surface is drawn at that moment."""
        return "when it is deflected most" + ("" if self.complete else " of the steps that were written")


def portrait_of(name: str, scene: Scene, trajectory: Trajectory, surface: DisplaySurface, moment: float) -> Portrait:
    """The portrait of a run, with its surface as it is at a moment [s]."""
    return Portrait(
        name,
        trajectory.sentence,
        scene.origin,
        trajectory,
        trajectory.at(np.linspace(0, trajectory.time[-1], SAMPLES)),
        trajectory.events,
        np.stack([surface.points.min(axis=0), surface.points.max(axis=0)]),
        _relief(scene, surface, moment),
        moment,
        scene.base,
    )


def _relief(scene: Scene, surface: DisplaySurface, moment: float) -> Relief | None:
    if scene.shapes is None:
        return None
    return relief_of(scene.moving_shapes, surface, moving_heights(scene, np.array([moment]))[0])


def deflected_most(scene: Scene, surface: DisplaySurface, times: FloatArray) -> float:
    """The first of times (k,) [s] at which the surface is deflected the most."""
    heights = moving_heights(scene, times)
    batches = (heights[start : start + BATCH] for start in range(0, len(times), BATCH))
    mean_squares = [np.square(surface.deflection(batch)).mean(axis=1) for batch in batches]
    return float(times[most_deflected(np.concatenate(mean_squares))])
