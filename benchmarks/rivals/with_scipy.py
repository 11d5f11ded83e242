"""scipy's solvers with events: rest by sampling and root search, break-away by Radau, sliding by DOP853.

Just off, friction turns the velocity at the rate Q/u, which is stiff; an explicit solver would creep there.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from rivals import with_numba, with_numpy
from rivals.problem import MASS, PathProblem

FloatArray = NDArray[np.float64]
Rate = Callable[[float, FloatArray], FloatArray]

FIRST_SPEED = 1e-13  # m/s, along the pull, that a slip starts with
LENGTH, SPEED = 1e-5, 1e-2  # m, m/s: what tolerances are relative to
FAST = 0.01  # of friction times a stroke: the speed from which on DOP853 takes over
SAMPLES = 32  # of a span at rest
REST = 0.2
MOST_PHASES = 20  # a span, a guard against running in circles


@dataclass
class Traced:
    """Where the part is at the end (2,) [m], and how often the right side was asked for."""

    place: FloatArray
    evaluations: int


def rate_in_numpy(problem: PathProblem) -> Rate:
    """d/dt of (x, y, v_x, v_y) while the part slides."""

    def rate(time: float, state: FloatArray) -> FloatArray:
        v = state[None, 2:]
        f = with_numpy.plate(state[None, :2], time, problem)
        acceleration, load = with_numpy.pull(f, v)
        slow = problem.friction.friction_limit(load) / MASS / with_numpy.length(f, v)
        return np.concatenate([state[2:], (acceleration - slow[:, None] * v)[0]])

    return rate


def rate_in_numba(problem: PathProblem) -> Rate:
    """The same, compiled."""
    points, breakpoints, forces, law = problem.points, problem.breakpoints, problem.forces, problem.friction.law
    scratch = np.empty((len(points), 3))
    return lambda time, state: with_numba.right_side(time, state, points, breakpoints, forces, law, scratch)


def trace(problem: PathProblem, rate: Rate, tolerance: float) -> Traced:
    """The path up to the end, or to where the part comes off; steps end at the breakpoints of the drives."""
    time, state, asked = 0.0, np.array([*problem.start, 0.0, 0.0]), 0

    def counted(t: float, y: FloatArray) -> FloatArray:
        nonlocal asked  # `nfev` leaves out what Radau's Jacobian takes
        asked += 1
        return rate(t, y)

    atol = tolerance * np.array([LENGTH, LENGTH, SPEED, SPEED])
    friction = float(problem.friction.friction_limit(0.0)) / MASS
    friction = float(problem.friction.friction_limit(0.0)) / MASS
    fast = FAST * friction * 0.5 / float(problem.frequencies.max())
    # Taken as rest: it would go on by a small part of atol.
    slow = min(REST * math.sqrt(friction * atol[0]), 0.5 * fast)
    events = {
        "stops": _falling(lambda _, y: math.hypot(y[2], y[3]) - slow),
        "falls back": _falling(lambda _, y: math.hypot(y[2], y[3]) - 0.5 * FIRST_SPEED),
        "is fast": _falling(lambda _, y: fast - math.hypot(y[2], y[3])),
    }
    if problem.friction.pull_off < math.inf:
        events["detaches"] = _falling(lambda t, y: _load(problem, t, y) + problem.friction.pull_off)
    mode = "rests"
    for _ in range(MOST_PHASES * len(problem.forces)):
        if mode == "rests":
            time, direction = slip(problem, time, state[:2])
            state[2:] = FIRST_SPEED * direction
            mode = "just off"
        if time >= problem.duration:
            return Traced(state[:2], asked)
        off = mode == "just off"
        names = [name for name in events if off or name in ("stops", "detaches")]
        later = problem.breakpoints[np.searchsorted(problem.breakpoints, time, side="right")]
        found = solve_ivp(
            counted,
            (time, later),
            state,
            "Radau" if off else "DOP853",
            rtol=tolerance,
            atol=atol,
            events=[events[name] for name in names],
            first_step=min(1e-12, later - time) if off else None,
        )
        time, state = found.t[-1], found.y[:, -1].copy()
        if found.status == 1:
            name = next(name for name, times in zip(names, found.t_events, strict=True) if len(times))
            if name == "detaches":
                return Traced(state[:2], asked)
            mode = "slides" if name == "is fast" else "rests"
    raise RuntimeError(f"{MOST_PHASES} phases a span did not reach the end of problem {problem.name}")


def _falling(event: Callable[[float, FloatArray], float]) -> Callable[[float, FloatArray], float]:
    event.terminal, event.direction = True, -1  # type: ignore[attr-defined]
    return event


def _load(problem: PathProblem, time: float, state: FloatArray) -> float:
    _, load = with_numpy.pull(with_numpy.plate(state[None, :2], time, problem), state[None, 2:])
    return float(load[0])


def slip(problem: PathProblem, time: float, place: FloatArray) -> tuple[float, FloatArray]:
    """When [s] a part at rest slips (the duration: it does not), and which way (2,), of length 1 along the surface."""
    # At a fixed place height and gradient are quintics over each span.
    spans = np.arange(np.searchsorted(problem.breakpoints[1:-1], time, side="right"), len(problem.forces))
    shapes = with_numpy.shapes(place[None], problem)
    quintics = np.stack([shapes.value[0], *shapes.gradient[0].T]) @ problem.forces[spans]  # (S, 3, 6)

    def margin(since: FloatArray, rows: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Friction's limit less the pull [m/s^2], the pull and the gradient."""
        s = since[..., None, None] ** np.arange(6)
        gradient = (rows[..., 1:, :] * s).sum(axis=-1)
        k = np.arange(2, 6)
        w_tt = (rows[..., 0, 2:] * k * (k - 1) * s[..., 0, :4]).sum(axis=-1)
        f = with_numpy.Plate(w_tt, gradient, np.zeros_like(gradient), np.zeros((*w_tt.shape, 2, 2)))
        pull, load = with_numpy.pull(f, np.zeros_like(gradient))
        limit = problem.friction.friction_limit(load) / MASS
        return limit - with_numpy.length(f, pull), pull, gradient

    begins, ends = problem.breakpoints[spans], problem.breakpoints[spans + 1]
    low = np.maximum(begins, time)
    times = low[:, None] + (ends - low)[:, None] * np.linspace(0, 1, SAMPLES)
    since = times - begins[:, None]
    rows = np.repeat(quintics, SAMPLES, axis=0)
    values, _, _ = margin(since.ravel(), rows)
    below = np.flatnonzero(values < 0)
    if not len(below):
        return problem.duration, np.zeros(2)
    k = below[0]
    span, flat = k // SAMPLES, since.ravel()
    at = flat[k]
    if k % SAMPLES and values[k - 1] > 0:
        row = quintics[span : span + 1]
        at = brentq(lambda t: float(margin(np.array([t]), row)[0][0]), flat[k - 1], at, xtol=1e-20, rtol=1e-15)
    _, pull, gradient = margin(np.array([at]), quintics[span : span + 1])
    norm = np.sqrt((pull**2).sum() + (pull * gradient).sum() ** 2)
    return float(begins[span] + at), pull[0] / norm
