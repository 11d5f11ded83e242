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

from rivals import with_numba
from rivals.problem import GRAVITY, MASS, RADIUS, PathProblem

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


def rate_of(problem: PathProblem) -> Rate:
    """d/dt of (x, y, v_x, v_y) while the part slides, compiled."""
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
    """The net load [N] of a part that slides."""
    span, at = np.searchsorted(problem.breakpoints[1:-1], time, side="right"), np.empty((len(problem.points), 3))
    with_numba.quintics(problem.forces[span], time - problem.breakpoints[span], at)
    return float(with_numba.pull(with_numba.plate(*state[:2], problem.points, at), *state[2:])[2])


def _shapes(problem: PathProblem, place: FloatArray) -> FloatArray:
    """Boggio's function, 16 pi G = R ln(R/S) + S - R, of each actuator and its gradient [1/m] at a place: (3, N)."""
    x, sources = place / RADIUS, problem.points / RADIUS
    square = (sources**2).sum(axis=1)
    offset, image = x - sources, x * square[:, None] - sources
    big_r, big_s = (offset**2).sum(axis=1), x @ x * square - 2 * sources @ x + 1
    by_r, by_s = np.log(big_r / big_s), 1 - big_r / big_s
    gradient = 2 / RADIUS * (by_r[:, None] * offset + by_s[:, None] * image)
    return with_numba.SCALE * np.stack([big_r * by_r + big_s - big_r, *gradient.T])


def slip(problem: PathProblem, time: float, place: FloatArray) -> tuple[float, FloatArray]:
    """When [s] a part at rest slips (the duration: it does not), and which way (2,), of length 1 along the surface."""
    # At a fixed place height and gradient are quintics over each span.
    spans = np.arange(np.searchsorted(problem.breakpoints[1:-1], time, side="right"), len(problem.forces))
    quintics = _shapes(problem, place) @ problem.forces[spans]  # (S, 3, 6)

    def margin(since: FloatArray, rows: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Friction's limit less the pull [m/s^2], the pull and the gradient."""
        s = since[..., None, None] ** np.arange(6)
        gradient = (rows[..., 1:, :] * s).sum(axis=-1)
        k = np.arange(2, 6)
        w_tt = (rows[..., 0, 2:] * k * (k - 1) * s[..., 0, :4]).sum(axis=-1)
        b, square = GRAVITY + w_tt, 1 + (gradient**2).sum(axis=-1)
        pull = -(b / square)[:, None] * gradient
        limit = problem.friction.friction_limit(MASS * b / np.sqrt(square)) / MASS
        return limit - np.sqrt((pull**2).sum(axis=-1) + (pull * gradient).sum(axis=-1) ** 2), pull, gradient

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
