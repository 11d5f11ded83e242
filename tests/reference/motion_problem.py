"""A part on a moving surface: the problem, its path, and what acts on the part at one place and time.

`motion_oracle` has the equations and solves them.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple, Protocol

import numpy as np


class Frame(NamedTuple):
    """What the surface does to a part at X with the velocity X'."""

    place: np.ndarray  # (3,) r
    velocity: np.ndarray  # (3,) r_t, that of the surface
    carried: np.ndarray  # (3,) r'' where X'' = 0
    normal: np.ndarray  # (3,)
    centre: np.ndarray  # (3, 2) dr/dX
    contact: np.ndarray  # (3, 2) J


class At(Protocol):
    """The surface at one place and time."""

    def frame(self, v: np.ndarray) -> Frame: ...


class Point(NamedTuple):
    """A surface whose points move upwards, and a part that is one of them, at one place and time."""

    w: float
    w_t: float
    w_tt: float
    gradient: np.ndarray  # (2,)
    gradient_t: np.ndarray
    hessian: np.ndarray  # (2, 2)
    base: np.ndarray = np.zeros(2)  # m/s^2, acceleration of the base

    def frame(self, v: np.ndarray) -> Frame:
        """Place and velocity in the plane are those relative to the base."""
        rises = self.w_tt + 2 * v @ self.gradient_t + v @ self.hessian @ v
        centre = np.vstack([np.eye(2), self.gradient])
        normal = np.array([*-self.gradient, 1.0]) / math.sqrt(1 + self.gradient @ self.gradient)
        place, velocity = np.array([0.0, 0.0, self.w]), np.array([0.0, 0.0, self.w_t])
        return Frame(place, velocity, np.array([*self.base, rises]), normal, centre, centre)


Surface = Callable[[float, float, float], At]  # x, y, t
Height = Callable[[float], tuple[float, float, float]]  # t -> h, h', h''


@dataclass
class Problem:
    """What moves on what. `limit`: Q(N) [N]; `breakpoints`: the times at which a derivative of the surface jumps."""

    surface: Surface
    mass: float
    limit: Callable[[float], float]
    breakpoints: Sequence[float] = ()
    gravity: tuple[float, float, float] = (0.0, 0.0, -9.80665)
    squeeze: float = 0.0
    pull_off: float = math.inf
    static_ratio: float = 1.0
    gap: Callable[[float, float], float] = field(default=lambda x, y: 1.0)  # m from the rim
    stroke_time: float = 1e-3  # s, only decides which of the formulations is used
    flies: bool = False  # whether it is followed where it comes off
    impact: float = 0.0  # tangential over normal impulse of a landing, at most


@dataclass
class Path:
    """Where it ended, and the events on the way as (kind, time, x, y)."""

    time: float
    position: np.ndarray
    velocity: np.ndarray
    events: list[tuple[str, float, float, float]]
    dissipated: float  # J, by friction and impacts
    kinetic: float  # J


class Force(NamedTuple):
    frame: Frame
    pull: np.ndarray  # (3,) m/s^2, along the surface
    load: float  # N
    limit: float  # Q/m

    def gives(self) -> np.ndarray:
        """The X' with which the contact slides along the friction J X' that keeps a part at rest.

        With J dX that works as the pull with (dr/dX) dX.
        """
        j = self.frame.contact
        return np.linalg.solve(j.T @ j, self.frame.centre.T @ self.pull)

    def needed(self) -> float:
        """The size of that friction per kg."""
        return size_of(self.frame.contact @ self.gives())

    def acceleration(self, v: np.ndarray) -> np.ndarray:
        """X'' of a part that slides, by d'Alembert: friction works with J dX, the other forces with (dr/dX) dX."""
        a, j = self.frame.centre, self.frame.contact
        slip = j @ v
        return np.linalg.solve(a.T @ a, a.T @ self.pull - self.limit * j.T @ slip / size_of(slip))

    def heats(self, v: np.ndarray) -> float:
        """W/kg"""
        return self.limit * size_of(self.frame.contact @ v)


def size_of(vector: np.ndarray) -> float:
    return math.sqrt(vector @ vector)


def force(problem: Problem, time: float, place: np.ndarray, v: np.ndarray) -> Force:
    f = problem.surface(place[0], place[1], time).frame(v)
    free = f.carried - np.array(problem.gravity)
    across = f.normal @ free
    load = problem.mass * across + problem.squeeze
    limit = problem.limit(max(load, -problem.pull_off)) / problem.mass
    return Force(f, across * f.normal - free, load, limit)
