"""The part of examples/ring_wave.toml: how fast the wave carries it, by a run, by scipy and in closed form."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from ring_field import WAVES, Field, Responses, is_inner
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from coupling import build_drives, build_friction, build_part, shared_surface
from coupling.case import Case
from particle import SurfaceMotion, Trajectory, simulate

SETTLED, CYCLES = 20, 80  # cycles of the wave that are left out, and the last one
TURN = 9.0  # s, longer than a turn
SMALL = 3e-6  # m/s, below which friction fades in scipy's integration
G = 9.80665


@dataclass(frozen=True)
class Ring:
    """The example, also with other drives."""

    case: Case
    surface: SurfaceMotion
    responses: Responses

    @staticmethod
    def of(case: Case) -> "Ring":
        return Ring(case, shared_surface(case, [build_drives(case)], TURN), Responses.of(case))

    def driven(self, scale: float = 1.0, track: float = 1.0, frequency: float | None = None, way: int = 1) -> "Ring":
        """With the forces of wave and track scaled, another frequency [Hz] of the wave; way -1: it runs clockwise."""
        actuators = []
        for one, inner in zip(self.case.actuators, is_inner(self.case), strict=True):
            changes = {"force": (scale if inner else track) * (one.force or 0.0)}
            if inner:
                changes |= {"frequency": frequency or one.frequency or 0.0, "phase": way * one.phase}
            actuators.append(one.model_copy(update=changes))
        case = self.case.model_copy(update={"actuators": tuple(actuators)})
        return Ring(case, self.surface.driven_by(build_drives(case)), self.responses)

    @cached_property
    def field(self) -> Field:
        return self.responses.field(self.case)

    @property
    def rate(self) -> float:
        """Of the wave, 1/s."""
        return min(term[0] for term in self.field.terms)

    @property
    def load(self) -> float:
        """What presses the part on, over its mass [m/s^2]."""
        return G + self.case.part.squeeze / self.case.part.mass

    @property
    def lift(self) -> float:
        """The wave's acceleration on its crest over that: from 1 on the part comes off."""
        return self.field.wave(self.field.crest, -WAVES) * self.rate**2 / self.load

    @property
    def centre(self) -> float:
        """The height [m] of the part's centre of mass over the mid-plane."""
        return self.case.plate.thickness / 2 + self.case.part.centre_height  # type: ignore[union-attr]

    @property
    def creeps(self) -> float:
        """The `lift` from which a part at rest slips on the crest's circle."""
        friction = self.case.friction.coefficient or 0.0
        return friction / math.hypot(friction, self.centre * WAVES / self.field.crest)

    @property
    def sliding(self) -> float:
        """The speed [m/s] of a part with so little friction that its speed hardly changes over a cycle."""
        angle = brentq(lambda x: x - math.pi / 2 - self.lift * math.sin(x), math.pi / 2, math.pi)
        along = self.centre * WAVES / self.field.crest * self.field.wave(self.field.crest, -WAVES) * self.rate
        return -math.cos(angle) * along

    def follow(self, radius: float, end: float, tolerance: float | None = None) -> Trajectory:
        part, law, run = build_part(self.case, (radius, 0.0)), build_friction(self.case), self.case.run
        return simulate(self.surface, part, law, end, run.gravity, tolerance or run.tolerance, after_detachment="fly")

    def speed(self, radius: float) -> float:
        """The mean speed [m/s] around the ring, counter-clockwise, of a part that starts at a radius."""
        times = 2 * math.pi * np.array([SETTLED, CYCLES]) / self.rate
        return around(self.follow(radius, times[1]).at(times).position, times)

    def by_scipy(self, radius: float) -> float:
        """The same by scipy, for small slopes, over the waves of the frequency responses."""
        part, friction = self.case.part, self.case.friction.coefficient or 0.0

        def rates(t: float, state: np.ndarray) -> list[float]:
            x, y, vx, vy = state.tolist()
            w_tt, slope, bend = self.field.at(x, y, t)
            brake = friction * (self.load + w_tt) / math.sqrt(vx**2 + vy**2 + SMALL**2)
            ax, ay = (self.centre * b - s * (G + w_tt) for b, s in zip(bend, slope, strict=True))
            return [vx, vy, ax - brake * vx, ay - brake * vy]

        assert part.squeeze
        times = 2 * math.pi * np.array([SETTLED, CYCLES]) / self.rate
        start, options = (radius, 0.0, 0.0, 0.0), {"rtol": 1e-6, "atol": [1e-10, 1e-10, 1e-7, 1e-7]}
        result = solve_ivp(rates, (0.0, times[1]), start, "LSODA", times, max_step=0.3 / self.rate, **options)
        return around(result.y[:2].T, times)


def around(places: np.ndarray, times: np.ndarray) -> float:
    """The mean speed [m/s] around the ring from the first place to the last."""
    angles, radius = np.unwrap(np.arctan2(places[:, 1], places[:, 0])), np.hypot(*places.T).mean()
    return float(radius * (angles[-1] - angles[0]) / (times[-1] - times[0]))
