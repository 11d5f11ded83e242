"""Result: what a run has found."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from common import draw, notebook_html
from coupling.case import Case
from coupling.display import DisplaySurface, display_surface, frame_times
from coupling.margins import MarginCurves, PathLoads
from coupling.scene import Scene
from coupling.summary import Summary
from fem_plate import PlateShapes
from particle import SurfaceMotion, Trajectory

if TYPE_CHECKING:
    from common import Axes, Figure


@dataclass(frozen=True, eq=False, repr=False)
class Result:
    """The result of a run.

    Parameters
    ----------
    case : Case
        What was run.
    scene : PlateScene or PlatformScene
        What the part moved over.
    trajectory : Trajectory
        The part's path.
    summary : Summary
        Its figures, and how exact they are.
    loads : PathLoads
        The loads on the part along its path.
    files : tuple of path
        Files that were written.
    """

    case: Case
    scene: Scene
    trajectory: Trajectory
    summary: Summary
    loads: PathLoads
    files: tuple[Path, ...] = ()

    @property
    def surface(self) -> SurfaceMotion:
        """The moving surface."""
        return self.scene.surface

    @property
    def shapes(self) -> PlateShapes | None:
        """The influence shapes of a plate; None: there is a platform."""
        return self.scene.shapes

    @cached_property
    def frames(self) -> NDArray[np.float64]:
        """The times (k,) [s] of the steps in files."""
        return frame_times(self.case, self.scene, float(self.trajectory.time[-1]))

    @cached_property
    def ground(self) -> DisplaySurface:
        """The surface as files and pictures have it."""
        return display_surface(self.scene, self.trajectory)

    @property
    def margin_curves(self) -> MarginCurves:
        """The margins over time."""
        return self.loads.curves

    def __repr__(self) -> str:
        text = f"{self.summary.sentence} It is {self.summary.distance:.4g} m from the start."
        return f"Result of {self.case!r}. {text}"

    def plot(self, axes: Axes | None = None) -> Figure:
        """Draw the path over the surface as it is when it is deflected most, and the motion over time.

        With axes, only the path over the surface, into these, in m.
        """
        return draw(self, axes)

    _repr_html_ = notebook_html
