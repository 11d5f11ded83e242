"""Path: a trajectory seen from the actuators, and what became of its part."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from active_surface.arrays import FloatArray
from particle import EventKind, Trajectory

LAST_CYCLES: Final = 5  # in which a part must stay near the actuator to have converged


@dataclass(frozen=True, eq=False)
class Path:
    """A trajectory with places counted from actuator 1."""

    trajectory: Trajectory
    offset: FloatArray

    @property
    def time(self) -> FloatArray:
        """(n,) s."""
        return self.trajectory.time

    @property
    def place(self) -> FloatArray:
        """(n, 2) m."""
        return self.trajectory.position - self.offset

    @property
    def outcome(self) -> str:
        """How it ended, as of `particle.Outcome`."""
        return self.trajectory.outcome.value

    @property
    def attached(self) -> bool:
        """Whether the part is on the surface at the end."""
        return self.outcome in ("stuck", "moving")

    @property
    def came_off(self) -> bool:
        """Whether the surface lost the part."""
        return self.outcome == "detached"

    @property
    def over_rim(self) -> bool:
        """Whether it left the surface over the rim."""
        return self.outcome == "left the plate"

    @property
    def unknown(self) -> bool:
        """Whether it was not followed to the end: more load than the friction law covers, or too much work."""
        return not (self.attached or self.came_off or self.over_rim)

    def away(self, actuator: ArrayLike = (0.0, 0.0)) -> FloatArray:
        """Distances (n,) [m] from an actuator."""
        return np.asarray(np.hypot(*(self.place - np.asarray(actuator)).T))

    def converged(self, period: float, near: float, actuator: ArrayLike = (0.0, 0.0)) -> bool:
        """Whether it spends the last five periods [s] within `near` [m] of an actuator."""
        late = self.time >= self.time[-1] - LAST_CYCLES * period
        return self.attached and bool((self.away(actuator)[late] <= near).all())

    def lost(self, far: float) -> bool:
        """Whether it leaves actuator 1, as below, or comes off."""
        return self.came_off or self.leaves_at(far) < np.inf

    def leaves_at(self, far: float) -> float:
        """When [s] it first gets farther than `far` [m] from actuator 1, or over the rim; inf: never."""
        beyond = np.flatnonzero(self.away() > far)
        if len(beyond):
            return float(self.time[beyond[0]])
        return float(self.time[-1]) if self.over_rim else np.inf

    def off_at(self, actuators: ArrayLike) -> tuple[float, float]:
        """How far [m] from the nearest of actuators (n, 2) the part came off, and its speed [m/s]; nan: it did not."""
        if not self.came_off:
            return np.nan, np.nan
        event = next(event for event in self.trajectory.events[::-1] if event.kind is EventKind.DETACHES)
        away = np.asarray(event.position) - self.offset - np.atleast_2d(np.asarray(actuators))
        return float(np.hypot(*away.T).min()), event.speed

    def drawn(self, count: int = 400) -> FloatArray:
        """Times and places (count, 3) [s, m, m] for a picture."""
        times = np.linspace(0, self.time[-1], count)
        return np.column_stack([times, self.trajectory.at(times).position - self.offset])
