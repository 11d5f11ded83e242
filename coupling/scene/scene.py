"""Scene: what a part moves over, and what the summary, the result files and the picture need of that."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from coupling.case import Case
from coupling.measured import MotionFit
from coupling.summary import PlateFigures
from fem_plate import PlateShapes
from particle import AnyDrive, SurfaceMotion, Trajectory

FloatArray = NDArray[np.float64]


class Ground(NamedTuple):
    """The surface as drawn."""

    points: FloatArray  # (n, 2) m
    triangles: NDArray[np.int64]  # (m, 3)
    lifted: Callable[[FloatArray], FloatArray]  # from heights (k, N) [m] of the drives to deflections (k, n) [m]
    bent: Callable[[FloatArray], FloatArray] | None = None  # likewise to curvatures [1/m]; None: it is always flat


class Scene(Protocol):
    """A plate on actuators, or a platform."""

    @property
    def surface(self) -> SurfaceMotion:
        """The moving surface."""

    @property
    def lifts(self) -> Sequence[AnyDrive]:
        """The N drives that deflect the surface."""

    @property
    def base(self) -> Sequence[AnyDrive]:
        """The drives that move it in its plane, along x and y; none: it stays."""

    @property
    def shapes(self) -> PlateShapes | None:
        """The shapes of a plate; None: it is none."""

    @property
    def origin(self) -> str:
        """What positions are counted from, in words."""

    @property
    def fits(self) -> tuple[MotionFit, ...]:
        """How closely it follows a measured motion; empty: it has none."""

    def ground(self, trajectory: Trajectory) -> Ground:
        """The surface as drawn with a path over it."""

    def onto(self, xy: FloatArray) -> FloatArray:
        """Points (n, 2) [m] themselves, or the nearest of the rim where they are just past it."""

    def figures(self, case: Case, trajectory: Trajectory) -> PlateFigures | None:
        """What the summary says of a plate; None: it is none."""
