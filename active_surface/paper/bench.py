"""The bench on which paths are found in three models, and what becomes of a part on such a path.

"paper": the paper's scheme of fixed steps on the surface of equation (2).  "closed": our equations with located events
on the same surface.  "plate": the same on a plate of finite elements, which all actuators are attached to.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from active_surface.arrays import FloatArray
from active_surface.paper.parameters import PARAMETERS, QUICK, Effort, Parameters, Place
from active_surface.paper.profiles import profile_outline, profile_surface
from coupling import PathTask, follow, one_blas_thread, surface_motion
from coupling.case import RunCase
from fem_plate import DiscShapes, Plate, Shapes
from meshes import Outline, disc
from particle import Drive, EventKind, Micropart, SurfaceMotion, Trajectory
from particle.friction import Contact

PAPER, CLOSED, PLATE = "paper", "closed", "plate"
MODELS: Final = {
    PAPER: "paper's scheme, closed form",
    CLOSED: "our equations, closed form",
    PLATE: "our equations, finite elements",
}
PLATE_TOLERANCE: Final = 1e-8
RINGS: Final = 12  # of cells, from which the plate is refined
LAST_CYCLES: Final = 5  # in which a part must stay near the actuator to have converged
STAYS, OFF, OVER, UNKNOWN = "ends on the surface", "comes off", "goes over the rim", "not followed"
ENDS: Final = {"stuck": STAYS, "moving": STAYS, "detached": OFF, "left the plate": OVER}
"""How paths end, by their outcome; with another one the part was not followed: too much load or work."""


class Ground(NamedTuple):
    """What a part moves over: one actuator at (0, 0), or two, the other one at (pitch, 0)."""

    surface: SurfaceMotion
    outline: Outline
    offset: FloatArray  # (2,) m, of the surface's own origin from actuator 1


@dataclass(eq=False)
class Bench:
    """Computes paths in every model; surfaces are made once."""

    parameters: Parameters = PARAMETERS
    effort: Effort = QUICK
    grounds: dict[tuple[str, str], Ground] = field(default_factory=dict)

    def ground(self, model: str, actuators: str = "one") -> Ground:
        """The ground of a model; actuators: "one", or for two "superposed" or "nearest", which a plate knows not."""
        solid = model == PLATE
        key = (model if solid else "profiles", "two" if solid and actuators != "one" else actuators)
        if key not in self.grounds:
            with one_blas_thread():
                self.grounds[key] = self._make(*key)
        return self.grounds[key]

    def _make(self, kind: str, actuators: str) -> Ground:
        p = self.parameters
        still = Drive(p.stroke, 1.0)
        if kind == "profiles" and actuators != "one":
            surface = profile_surface(actuators, p.pitch, p.radius, [still, still])
            return Ground(surface, profile_outline(p.pitch, p.radius), np.zeros(2))
        points = np.array([[0.0, 0.0]] if actuators == "one" else [[0.0, 0.0], [p.pitch, 0.0]])
        offset = points.mean(axis=0)
        shapes: Shapes
        if kind == PLATE:
            plate = Plate(disc(p.radius, p.radius / RINGS), p.section, tolerance=PLATE_TOLERANCE)
            shapes = plate.influence(points - offset)  # type: ignore[assignment]
        else:
            shapes = DiscShapes(points, p.radius)
        return Ground(surface_motion(shapes, [still] * len(points)), shapes.outline, -offset)

    def drive(self, frequency: float, stroke: float | None = None, cycles: int | None = None) -> Drive:
        """An up-down drive, continuous or with a number of cycles."""
        return Drive(self.parameters.stroke if stroke is None else stroke, frequency, cycles=cycles)

    def duration(self, *drives: Drive) -> float:
        """How long [s] continuous drives run, by cycles of the slowest."""
        return self.parameters.cycles / min(drive.frequency for drive in drives)

    def paths(
        self,
        model: str,
        drives: Sequence[Drive],
        starts: ArrayLike,
        duration: float,
        velocities: ArrayLike = (0.0, 0.0),
        ground: Ground | None = None,
        friction: Contact | None = None,
        tolerance: float | None = None,
    ) -> list[Path]:
        """One path from each start (n, 2) [m], with velocities (n, 2) or (2,) [m/s]; places count from actuator 1.

        Over one actuator with the friction and the tolerance of the parameters, where nothing else is given.
        """
        p, ground = self.parameters, ground or self.ground(model)
        surface = ground.surface.driven_by(drives)
        places = np.atleast_2d(np.asarray(starts, dtype=float))
        speeds = np.broadcast_to(np.asarray(velocities, dtype=float), places.shape)
        parts = [
            Micropart(p.mass, (float(x), float(y)), (float(u), float(v)))
            for (x, y), (u, v) in zip(places + ground.offset, speeds, strict=True)
        ]
        law = p.friction if friction is None else friction
        steps = {"scheme": "paper", "time_step": p.time_step} if model == PAPER else {}
        run = RunCase(duration=duration, gravity=p.gravity, tolerance=tolerance or p.tolerance, **steps)
        return [Path(one, ground.offset) for one in follow([PathTask(surface, part, law, run) for part in parts])]

    def count(self, model: str) -> int:
        """How many starts there are for a model."""
        return self.effort.starts_by_steps if model == PAPER else self.effort.starts

    def starts(self, place: Place, count: int) -> FloatArray:
        """The place itself and others around it, (count, 2) m; the same ones for every model."""
        jitter = self.parameters.jitter
        random = np.random.default_rng(self.parameters.seed)
        moved = np.asarray(place) + jitter * random.uniform(-1, 1, (count, 2))
        moved[0] = place
        return moved


@dataclass(frozen=True, eq=False)
class Path:
    """A trajectory with places counted from actuator 1."""

    trajectory: Trajectory
    offset: FloatArray  # (2,) m

    @property
    def time(self) -> FloatArray:
        """(n,) s."""
        return self.trajectory.time

    @property
    def place(self) -> FloatArray:
        """(n, 2) m."""
        return self.trajectory.position - self.offset

    @property
    def end(self) -> str:
        """What becomes of the part: STAYS, OFF, OVER or UNKNOWN."""
        return ENDS.get(self.trajectory.outcome.value, UNKNOWN)

    def away(self, actuator: ArrayLike = (0.0, 0.0)) -> FloatArray:
        """Distances (n,) [m] from an actuator."""
        return np.asarray(np.hypot(*(self.place - np.asarray(actuator)).T))

    def converged(self, period: float, near: float, actuator: ArrayLike = (0.0, 0.0)) -> bool:
        """Whether it spends the last five periods [s] within `near` [m] of an actuator."""
        late = self.time >= self.time[-1] - LAST_CYCLES * period
        return self.end == STAYS and bool((self.away(actuator)[late] <= near).all())

    def reaches(self, actuator: Place, within: float) -> float:
        """When [s] it is first nearer than `within` [m] to an actuator; inf: never."""
        close = np.flatnonzero(self.away(actuator) < within)
        return float(self.time[close[0]]) if len(close) else np.inf

    def leaves_at(self, far: float) -> float:
        """When [s] it first gets farther than `far` [m] from actuator 1, or over the rim; inf: never."""
        beyond = np.flatnonzero(self.away() > far)
        if len(beyond):
            return float(self.time[beyond[0]])
        return float(self.time[-1]) if self.end == OVER else np.inf

    def lost(self, far: float) -> bool:
        """Whether it leaves actuator 1 or comes off."""
        return self.end == OFF or self.leaves_at(far) < np.inf

    def off_at(self, actuators: ArrayLike) -> float:
        """How far [m] from the nearest of actuators (n, 2) the part came off; nan: it did not."""
        if self.end != OFF:
            return np.nan
        event = next(event for event in self.trajectory.events[::-1] if event.kind is EventKind.DETACHES)
        away = np.asarray(event.position) - self.offset - np.atleast_2d(np.asarray(actuators))
        return float(np.hypot(*away.T).min())

    def drawn(self, count: int = 400) -> FloatArray:
        """Times and places (count, 3) [s, m, m] for a picture."""
        times = np.linspace(0, self.time[-1], count)
        return np.column_stack([times, self.trajectory.at(times).position - self.offset])


def coming_off(paths: Sequence[Path], actuators: ArrayLike) -> dict[str, float]:
    """The share that comes off, and the median of the distance [m] from the nearest of actuators (n, 2) at which."""
    away = np.array([path.off_at(actuators) for path in paths])
    off = np.isfinite(away)
    return {"come_off": float(off.mean()), "median_distance": float(np.median(away[off])) if off.any() else np.nan}
