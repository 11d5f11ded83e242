"""The models side by side, and the bench on which paths are found in each of them.

"paper": the paper's scheme of fixed steps on the surface of equation (2).  "closed": our equations with located events
on the same surface.  "plate": the same on a plate of finite elements, which all actuators are attached to.
"""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from functools import partial
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from threadpoolctl import threadpool_limits

from active_surface.arrays import FloatArray
from active_surface.paper.parameters import PARAMETERS, Effort, Parameters, Place
from active_surface.paper.path import Path
from active_surface.paper.profiles import profile_outline, profile_surface
from coupling import surface_motion
from fem_plate import DiscShapes, Plate, PlateSection, Shapes
from meshes import Outline, disc
from particle import Drive, Micropart, SurfaceMotion, Trajectory, processors, simulate, simulate_many
from particle.friction import Contact

PAPER, CLOSED, PLATE = "paper", "closed", "plate"
MODELS: Final = {
    PAPER: "paper's scheme, closed form",
    CLOSED: "our equations, closed form",
    PLATE: "our equations, finite elements",
}
PLATE_TOLERANCE: Final = 1e-8
RINGS: Final = 12  # of cells, from which the plate is refined


class Ground(NamedTuple):
    """What a part moves over: one actuator at (0, 0), or two, the other one at (pitch, 0)."""

    surface: SurfaceMotion
    outline: Outline
    offset: FloatArray  # (2,) m, of the surface's own origin from actuator 1


@dataclass(eq=False)
class Bench:
    """Computes paths in every model; surfaces are made once."""

    parameters: Parameters = PARAMETERS
    margin: float = 0.0  # m, by which two actuators' closed forms go on flat beyond their rim
    grounds: dict[tuple[str, str], Ground] = field(default_factory=dict)  # may be shared where only parts differ

    def ground(self, model: str, actuators: str = "one") -> Ground:
        """The ground of a model; actuators: "one", or for two "superposed" or "nearest", which a plate knows not."""
        solid = model == PLATE
        key = (model if solid else "profiles", "two" if solid and actuators != "one" else actuators)
        if key not in self.grounds:
            with threadpool_limits(limits=1, user_api="blas"):
                self.grounds[key] = self._make(*key)
        return self.grounds[key]

    def _make(self, kind: str, actuators: str) -> Ground:
        p = self.parameters
        still = Drive(p.stroke, 1.0)
        if kind == PLATE:
            points = np.array([[0.0, 0.0]] if actuators == "one" else [[0.0, 0.0], [p.pitch, 0.0]])
            offset = points.mean(axis=0)
            section = PlateSection(p.youngs_modulus, p.poisson_ratio, p.thickness, p.density)
            plate = Plate(disc(p.radius, p.radius / RINGS), section, tolerance=PLATE_TOLERANCE)
            shapes: Shapes = plate.influence(points - offset)  # type: ignore[assignment]
            return Ground(surface_motion(shapes, [still] * len(points)), shapes.outline, -offset)
        if actuators == "one":
            shapes = DiscShapes([[0.0, 0.0]], p.radius)
            return Ground(surface_motion(shapes, [still]), shapes.outline, np.zeros(2))
        surface = profile_surface(actuators, p.pitch, p.radius, [still, still], self.margin)
        return Ground(surface, profile_outline(p.pitch, p.radius, self.margin), np.zeros(2))

    def drive(self, frequency: float, stroke: float | None = None, cycles: int | None = None) -> Drive:
        """An up-down drive, continuous or with a number of cycles."""
        p = self.parameters
        return Drive(p.stroke if stroke is None else stroke, frequency * p.period_share, cycles=cycles)

    def duration(self, *drives: Drive) -> float:
        """How long [s] continuous drives run, by cycles of the slowest."""
        return self.parameters.cycles / min(drive.frequency for drive in drives)

    def surface(self, model: str, drives: Sequence[Drive], duration: float, actuators: str = "one") -> SurfaceMotion:
        """The surface of a model under drives, for a time [s]."""
        return self.ground(model, actuators).surface.driven_by(drives)

    def paths(
        self,
        model: str,
        drives: Sequence[Drive],
        starts: ArrayLike,
        duration: float,
        velocities: ArrayLike = (0.0, 0.0),
        actuators: str = "one",
        friction: Contact | None = None,
        tolerance: float | None = None,
    ) -> list[Path]:
        """One path from each start (n, 2) [m], with velocities (n, 2) or (2,) [m/s]; places count from actuator 1."""
        p, ground = self.parameters, self.ground(model, actuators)
        surface = self.surface(model, drives, duration, actuators)
        places = np.atleast_2d(np.asarray(starts, dtype=float))
        speeds = np.broadcast_to(np.asarray(velocities, dtype=float), places.shape)
        parts = [
            Micropart(p.mass, (float(x), float(y)), (float(u), float(v)), p.centre_height)
            for (x, y), (u, v) in zip(places + ground.offset, speeds, strict=True)
        ]
        law = p.friction if friction is None else friction
        if model == PAPER:
            one = partial(_by_steps, surface, law, duration, p.gravity, p.time_step)
            with ThreadPoolExecutor(processors()) as pool:
                try:
                    results = list(pool.map(one, parts))
                except BaseException:  # Ctrl-C: each path takes a fraction of a second, all together long
                    pool.shutdown(wait=True, cancel_futures=True)
                    raise
        else:
            results = simulate_many(surface, parts, law, duration, p.gravity, tolerance or p.tolerance)
        return [Path(trajectory, ground.offset) for trajectory in results]

    def starts(self, place: Place, count: int) -> FloatArray:
        """The place itself and others around it, (count, 2) m; the same ones for every model."""
        jitter = self.parameters.jitter
        random = np.random.default_rng(self.parameters.seed)
        moved = np.asarray(place) + jitter * random.uniform(-1, 1, (count, 2))
        moved[0] = place
        return moved

    def starts_of(self, model: str, effort: Effort) -> int:
        """How many starts there are for a model."""
        return effort.starts_by_steps if model == PAPER else effort.starts


def _by_steps(
    surface: SurfaceMotion, law: Contact, duration: float, gravity: float, step: float, part: Micropart
) -> Trajectory:
    return simulate(surface, part, law, duration, gravity, scheme="paper", time_step=step)
