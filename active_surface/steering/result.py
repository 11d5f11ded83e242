"""Results of aims and plans: a case with the best drives, its path, and how near this comes to the targets."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from active_surface.steering.knobs import Stop
from active_surface.steering.legs import Leg
from active_surface.steering.paths import settled
from active_surface.steering.robustness import Scatter
from active_surface.steering.settings import Settings
from active_surface.steering.task import Place, Route, Task, offset_of
from common import joined
from coupling.case import Case, length_text
from particle import Trajectory


@dataclass(frozen=True, eq=False, kw_only=True)
class _Result:
    """A case with the best drives, and its path.

    scatter: None after Ctrl-C.  paths: how many were followed to find the drives.
    interrupted: whether Ctrl-C ended the search.  warnings: where the model stops holding.  files: those written.
    """

    case: Case
    trajectory: Trajectory = field(repr=False)
    paths: int
    scatter: Scatter | None = field(default=None, repr=False)
    interrupted: bool = False
    warnings: tuple[str, ...] = ()
    files: tuple[Path, ...] = ()


@dataclass(frozen=True, eq=False, kw_only=True)
class Aimed(_Result):
    """The case with the drives of an aim, its path, and how far it ends from the target.

    Parameters
    ----------
    legs : tuple
        The legs of the way, one after the other. The drives of a single leg are cycles, those of several are
        segments.
    stops : tuple
        The knobs that stand at a bound of the search.
    """

    task: Task
    legs: tuple[Leg, ...]
    stops: tuple[Stop, ...] = ()

    @property
    def settings(self) -> Settings:
        """Bounds and effort of the search."""
        return self.task.settings

    @property
    def targets(self) -> tuple[Place, ...]:
        """The target [m]."""
        return (self.task.target,)

    def off(self, path: Trajectory) -> float:
        """How far off the target a path ends [m], in place and in a heading to reach, counted as a length."""
        return float(np.hypot.reduce(offset_of(path, self.task.target, self.task.turn)))

    @property
    def distance(self) -> float:
        """From the path's end to the target [m]; with a heading to reach, what is missed of it counts as a length."""
        return self.off(self.trajectory)

    @property
    def turn_left(self) -> float | None:
        """From the target's heading to the part's at the end [rad]; None: any heading will do."""
        turn, heading = self.task.turn, self.trajectory.heading
        return None if turn is None or heading is None else turn.left(float(heading[-1]))

    @property
    def reached(self) -> bool:
        """Whether the part comes to a final rest within the tolerance of the target."""
        return self.distance <= self.task.settings.tolerance and settled(self.trajectory)

    @property
    def head(self) -> str:
        """The head of the case file: how near the drives bring the part to the target, or that they miss it."""
        x, y = map(length_text, self.task.target)
        away, target = length_text(self.distance), f"({x}, {y})"
        if (heading := self.task.heading) is not None:
            target += f" with the heading {math.degrees(heading):g} deg"
        if self.reached:
            return f"The drives bring the part to within {away} of {target}."
        return f"The target {target} is missed: the part ends {away} from it."


@dataclass(frozen=True, eq=False, kw_only=True)
class Planned(_Result):
    """The case with the schedule of a plan, its path, and how each leg ended.

    Parameters
    ----------
    arrivals : tuple of float
        When the part comes to a final rest at each way-point, or beside it, s.
    tried : int
        Number of way-points with drives, including one on whose way the path failed.
    stops : tuple of tuple
        The knobs that stand at a bound of the search, of each leg.
    failure : str
        Why there are fewer arrivals than way-points; empty if there are not, or if Ctrl-C came.
    """

    route: Route
    arrivals: tuple[float, ...]
    tried: int
    stops: tuple[tuple[Stop, ...], ...] = ()
    failure: str = ""

    @property
    def settings(self) -> Settings:
        """Bounds and effort of the search."""
        return self.route.settings

    @property
    def targets(self) -> tuple[Place, ...]:
        """The way-points [m] for which there are drives: the last of them is where these are to end."""
        return self.route.through[: self.tried]

    def off(self, path: Trajectory) -> float:
        """How far from the last of them a path ends [m]."""
        return float(np.hypot(*(path.position[-1] - self.targets[-1])))

    @property
    def distances(self) -> list[float]:
        """From the part to each way-point [m] when it has arrived there."""
        return self.route.distances(self.trajectory.at(self.arrivals).position.tolist())

    @property
    def reached(self) -> list[bool]:
        """Whether it arrived at each way-point within the tolerance."""
        return [distance <= self.route.settings.tolerance for distance in self.distances]

    @property
    def complete(self) -> bool:
        """Whether every way-point was reached, within the tolerance."""
        return len(self.arrivals) == len(self.route.through) and all(self.reached)

    @property
    def head(self) -> str:
        """The head of the case file: which way-points are missed, how near the part comes to each, why no farther."""
        missed = [str(number) for number, reached in enumerate(self.reached) if not reached]
        legs = zip(self.route.through, self.distances, strict=False)
        places = [f"{length_text(off)} of ({length_text(x)}, {length_text(y)})" for (x, y), off in legs]
        sentences = [f"The drives miss way-point{'s' * (len(missed) > 1)} {joined(missed)}."] if missed else []
        sentences += [f"The drives carry the part to within {', '.join(places)}."] if places else []
        return "\n".join([*sentences, self.failure] if self.failure else sentences)


SteeringResult = Aimed | Planned
