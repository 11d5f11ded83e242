"""Parameters for all figures, and the bench on which paths are found with them in three models.

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
from active_surface.paper.profiles import profile_outline, profile_surface
from coupling import PathTask, follow, one_blas_thread, surface_motion
from coupling.case import RunCase
from fem_plate import DiscShapes, Plate, PlateSection, Shapes
from meshes import Outline, disc
from particle import Drive, EventKind, KogutEtsion, Micropart, SurfaceMotion, Trajectory
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
Place = tuple[float, float]  # m


@dataclass(frozen=True)
class Parameters:
    """What the paper states, and what it leaves open (docs/paper.md): one set for all figures.

    What one figure alone needs and the paper does not state stands beside its computation.
    """

    radius: float = 300e-6  # m, a of equation (2); left open
    pitch: float = 150e-6  # m, between two actuators
    stroke: float = 150e-6  # m
    strokes: tuple[float, ...] = (100e-6, 200e-6)  # m, least and largest of figure 18
    slipping: tuple[float, ...] = (80e-6, 95e-6, 110e-6)  # m, strokes of figures 5 and 6; left open
    carrying: tuple[float, ...] = (60e-6, 70e-6, 80e-6, 90e-6, 100e-6)  # m, strokes of figure 15; left open
    mass: float = 2e-9  # kg
    gravity: float = 0.0  # m/s^2; the paper's forces have no weight
    friction: Contact = field(default_factory=KogutEtsion.paper)
    start: Place = (100e-6, 100e-6)  # figure 17, and wherever none is given
    cycles: int = 30  # how long continuous drives run
    time_step: float = 2e-6  # s, of the paper's scheme; left open
    tolerance: float = 1e-8  # of the located events
    jitter: float = 1e-6  # m, by which starts are displaced at most along x and along y: places are given in um
    near: float = 30e-6  # m: a part has converged that spends the last five cycles so close to the actuator
    far: float = 200e-6  # m: it has left the actuator's region when it gets farther than that, or over the rim
    youngs_modulus: float = 169e9  # Pa; with rigid actuators and a clamped rim neither it nor the thickness counts
    poisson_ratio: float = 0.3  # of the plate
    thickness: float = 5e-6  # m
    density: float = 2330.0  # kg/m^3, of the plate; counts with inertia alone
    contact_side: float = 100e-6  # m, of the part's square contact
    seed: int = 4

    @property
    def section(self) -> PlateSection:
        """Of the plate."""
        return PlateSection(self.youngs_modulus, self.poisson_ratio, self.thickness, self.density)


PARAMETERS = Parameters()


class Effort(NamedTuple):
    """How many starts, frequencies and places are looked at."""

    name: str
    starts: int  # jittered starts with located events
    starts_by_steps: int  # with the paper's scheme, whose paths take a hundred times longer
    frequencies: int  # of figures 5, 6 and 15
    step: float  # Hz, between frequencies of figure 18
    strokes: int  # of figure 18
    across: int  # places along the plate, figures 5 and 6
    pitches: int  # of the dead zones
    candidates: int  # frequencies tried there


QUICK = Effort("quick", 60, 36, 40, 20.0, 5, 50, 11, 6)
FULL = Effort("full", 400, 100, 80, 10.0, 9, 120, 11, 12)
TINY = Effort("tiny", 2, 1, 3, 200.0, 2, 12, 1, 1)  # for tests: shows that it runs, and nothing else


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

    def paths(
        self,
        model: str,
        drives: Sequence[Drive],
        starts: ArrayLike,
        duration: float | None = None,
        velocities: ArrayLike = (0.0, 0.0),
        ground: Ground | None = None,
        friction: Contact | None = None,
        tolerance: float | None = None,
    ) -> list[Path]:
        """One path from each start (n, 2) [m], with velocities (n, 2) or (2,) [m/s]; places count from actuator 1.

        Over one actuator with the friction and the tolerance of the parameters, for as long as the slowest drive takes
        for their number of cycles, where nothing else is given.
        """
        p, ground = self.parameters, ground or self.ground(model)
        surface, slowest = ground.surface.driven_by(drives), min(drive.frequency for drive in drives)
        places = np.atleast_2d(np.asarray(starts, dtype=float))
        speeds = np.broadcast_to(np.asarray(velocities, dtype=float), places.shape)
        parts = [
            Micropart(p.mass, (float(x), float(y)), (float(u), float(v)))
            for (x, y), (u, v) in zip(places + ground.offset, speeds, strict=True)
        ]
        law = p.friction if friction is None else friction
        steps = {"scheme": "paper", "time_step": p.time_step} if model == PAPER else {}
        end = duration or p.cycles / slowest
        run = RunCase(duration=end, gravity=p.gravity, tolerance=tolerance or p.tolerance, **steps)
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
