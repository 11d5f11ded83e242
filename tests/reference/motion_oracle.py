"""A point part on a moving surface, integrated a second time: scipy's solvers, events by root finding, closed forms.

    z'' = d^2/dt^2 w(x, y, t) fixes the normal force:
    B = g + w_tt + 2 v.G_t + v.H v - a.G,  N = m B/s + squeeze,  v' = p - (Q/m) v/u,  p = -a - B G/s^2

with G = grad w, s^2 = 1 + |G|^2, u^2 = v.M v, M = I + G G^T, and a the base's acceleration less gravity's share there.
Sliding is DOP853 in (x, y, v). Where u is small compared with friction times a stroke, it is either

- on its way to rest: with dt = u ds the equations in (t, x, y, ln u, n = v/u) are regular, n' = p - (Q/m + du/dt) n,
  du/dt = n.M p - Q/m + u (n.G)(n.dG/dt), and u falls exponentially in s; or
- just off: the direction relaxes at the rate Q/(m u), and Radau takes (x, y, v) from a speed of 1e-13 m/s along p.

Everything that ends a piece is located by repeating the last step, not by its interpolant. Slow: seconds a case.
With RTOL or FIRST_SPEED smaller still, the ends of the reference cases move by less than 2e-11 of the plate's radius.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from scipy.integrate import DOP853, Radau, solve_ivp
from scipy.optimize import brentq

RTOL, LENGTH_ERROR, SPEED_ERROR = 1e-13, 1e-18, 1e-16  # of one step; m, m/s (a plate is 1e-4 m wide)
FIRST_SPEED, LAST_SPEED = 1e-13, 1e-14  # m/s
SCAN = 4000  # moments of a span at which a part at rest is looked at
INSIDE = np.linspace(0, 1, 7)[1:]  # of a step: where its interpolant is searched for events


class Point(NamedTuple):
    """The surface at one place and time."""

    w: float
    w_t: float
    w_tt: float
    gradient: np.ndarray  # (2,)
    gradient_t: np.ndarray
    hessian: np.ndarray  # (2, 2)
    base: np.ndarray = np.zeros(2)  # m/s^2, acceleration of the base


Surface = Callable[[float, float, float], Point]  # x, y, t
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


@dataclass
class Path:
    """Where it ended, and the events on the way as (kind, time, x, y)."""

    time: float
    position: np.ndarray
    velocity: np.ndarray
    events: list[tuple[str, float, float, float]]


class Force(NamedTuple):
    pull: np.ndarray  # p, (2,)
    load: float  # N
    limit: float  # Q/m
    metric: np.ndarray  # M
    turn: np.ndarray  # dG/dt
    gradient: np.ndarray


def force(problem: Problem, time: float, place: np.ndarray, v: np.ndarray) -> Force:
    f = problem.surface(place[0], place[1], time)
    a = f.base - np.array(problem.gravity[:2])
    g = f.gradient
    b = -problem.gravity[2] + f.w_tt + 2 * v @ f.gradient_t + v @ f.hessian @ v - a @ g
    square = 1 + g @ g
    load = problem.mass * b / math.sqrt(square) + problem.squeeze
    limit = problem.limit(max(load, -problem.pull_off)) / problem.mass
    return Force(-a - b * g / square, load, limit, np.eye(2) + np.outer(g, g), f.gradient_t + f.hessian @ v, g)


def size_of(vector: np.ndarray, f: Force) -> float:
    """Its length along the surface."""
    return math.sqrt(vector @ f.metric @ vector)


def trace(problem: Problem, position: Sequence[float], velocity: Sequence[float], duration: float) -> Path:
    """The path up to `duration`, or to where the part comes off or leaves the plate."""
    place, v, time, events = np.array(position, float), np.array(velocity, float), 0.0, []

    def note(kind: str) -> None:
        events.append((kind, time, *place.tolist()))

    edges = np.unique([0.0, *(k for k in problem.breakpoints if 0 < k < duration), duration])
    mode = "slide" if v.any() else "rest"
    for end in edges[1:].tolist():
        while time < end:
            if mode == "rest":
                time, found = rest(problem, time, end, place)
            else:
                if mode == "off":
                    v = FIRST_SPEED * (p := force(problem, time, place, np.zeros(2))).pull / size_of(p.pull, p)
                time, place, v, found = slide(problem, time, end, place, v, mode == "off")
            if found in ("detaches", "leaves"):
                note(found)
                return Path(time, place, v, events)
            if found == "slips":
                note("slips")
                mode = "off"
            elif found == "at rest":
                v = np.zeros(2)
                f = force(problem, time, place, v)
                held = size_of(f.pull, f) <= problem.static_ratio * f.limit
                note("stops" if held else "reverses")
                mode = "rest" if held else "off"
            elif mode == "off":  # it is fast enough by now, or a breakpoint came: its velocity is all there is to know
                mode = "slide" if found == "fast" or time >= end else mode
    return Path(time, place, v, events)


def rest(problem: Problem, time: float, end: float, place: np.ndarray) -> tuple[float, str]:
    """Until the pull exceeds friction or the load pull-off."""

    def slack(moment: float) -> float:
        f = force(problem, moment, place, np.zeros(2))
        return problem.static_ratio * f.limit - size_of(f.pull, f)

    def grip(moment: float) -> float:
        return force(problem, moment, place, np.zeros(2)).load + problem.pull_off

    moments = np.linspace(time, end, SCAN)
    kinds = [("slips", slack)] + ([("detaches", grip)] if problem.pull_off < math.inf else [])
    found = []
    for kind, measure in kinds:
        values = np.array([measure(moment) for moment in moments])
        # A part that has just come to rest, or that rested up to a breakpoint, is held there but for rounding.
        below = np.flatnonzero(values < -1e-9 * max(1.0, float(np.abs(values).max())))
        if len(below):
            k = below[0]
            late = k == 0 or values[k - 1] <= 0
            before = moments[max(k - 1, 0)]
            root = before if late else brentq(measure, before, moments[k], xtol=1e-18, rtol=1e-15)
            found.append((float(root), kind))
    return min(found) if found else (end, "")


def slide(
    problem: Problem, time: float, end: float, place: np.ndarray, v: np.ndarray, off: bool
) -> tuple[float, np.ndarray, np.ndarray, str]:
    """Until the end, rest, detachment or the rim; `off`: begins with Radau, and ends where that is no longer needed."""

    def rate(moment: float, y: np.ndarray) -> np.ndarray:
        f = force(problem, moment, y[:2], y[2:4])
        return np.concatenate([y[2:4], f.pull - f.limit * y[2:4] / size_of(y[2:4], f)])

    def speed_left(moment: float, y: np.ndarray) -> float:
        """Over the speed below which friction would stop it in a hundredth of a stroke."""
        f = force(problem, moment, y[:2], y[2:4])
        return size_of(y[2:4], f) - 0.01 * f.limit * problem.stroke_time

    def contact(moment: float, y: np.ndarray) -> float:
        return force(problem, moment, y[:2], y[2:4]).load + problem.pull_off

    def inside(moment: float, y: np.ndarray) -> float:
        return problem.gap(y[0], y[1])

    atol = np.array([LENGTH_ERROR, LENGTH_ERROR, SPEED_ERROR, SPEED_ERROR])
    y = np.concatenate([place, v])
    ends = [("detaches", contact), ("leaves", inside)]
    if off:
        fast = ("fast", lambda moment, y: -speed_left(moment, y))
        t, y, found = march(Radau, rate, time, y, end, atol, [*ends, fast], first_step=1e-13)
        return t, y[:2], y[2:], found
    if speed_left(time, y) > 0:
        t, y, found = march(DOP853, rate, time, y, end, atol, [*ends, ("slow", speed_left)])
        if found != "slow":
            return t, y[:2], y[2:], found
        time = t
    return to_rest(problem, time, end, y, ends)


def to_rest(
    problem: Problem, time: float, end: float, y: np.ndarray, ends: list
) -> tuple[float, np.ndarray, np.ndarray, str]:
    """The regular form, z = (t, x, y, ln u, n)."""

    def rate(_: float, z: np.ndarray) -> np.ndarray:
        u, n = math.exp(z[3]), z[4:]
        f = force(problem, z[0], z[1:3], u * n)
        n = n / size_of(n, f)  # 1 but for errors, which grow where it moves against the pull
        gain = n @ f.metric @ f.pull - f.limit + u * (n @ f.gradient) * (n @ f.turn)
        return np.concatenate([[u], u * u * n, [gain], f.pull - (f.limit + gain) * n])

    def plain(z: np.ndarray) -> np.ndarray:
        return np.concatenate([z[1:3], math.exp(z[3]) * z[4:]])

    f = force(problem, time, y[:2], y[2:])
    u = size_of(y[2:], f)
    fast = math.log(max(4 * u, 0.04 * f.limit * problem.stroke_time))
    stops = [(kind, lambda _, z, of=measure: of(z[0], plain(z))) for kind, measure in ends]
    stops += [
        ("", lambda _, z: end - z[0]),
        ("at rest", lambda _, z: z[3] - math.log(LAST_SPEED)),
        ("fast", lambda _, z: fast - z[3]),  # it did not come to rest: a turn
    ]
    z = np.array([time, *y[:2], math.log(u), *(y[2:] / u)])
    atol = np.array([1e-18, LENGTH_ERROR, LENGTH_ERROR, 1e-13, 1e-13, 1e-13])
    _, z, found = march(DOP853, rate, 0.0, z, math.inf, atol, stops)
    y = plain(z)
    return (end if found == "" else z[0]), y[:2], y[2:], "" if found == "fast" else found


def march(method, rate, start, y, end, atol, events, **options):
    """One solver up to the end or the first of the events, (kind, function that falls through 0)."""
    solver = method(rate, start, y, end, rtol=RTOL, atol=atol, **options)
    values = [max(measure(start, y), 0.0) for _, measure in events]
    while solver.status == "running":
        before, y_before = solver.t, solver.y.copy()
        message = solver.step()
        if solver.status == "failed":
            raise RuntimeError(message)
        between = solver.dense_output()
        hits = []
        for (kind, measure), value in zip(events, values, strict=True):
            for share in INSIDE:
                at = before + share * (solver.t - before)
                if value >= 0 > measure(at, solver.y if share == 1 else between(at)):
                    hits.append((at, kind, measure))
                    break
        if hits:
            found = []
            for at, kind, measure in hits:
                found.append((_locate(method, rate, before, y_before, at, atol, measure), kind))
            (t, y), kind = min(found, key=lambda one: one[0][0])
            return t, y, kind
        values = [measure(solver.t, solver.y) for _, measure in events]
    return solver.t, solver.y, ""


def _locate(method, rate, before, y_before, at, atol, measure):
    """The event's time and state, by repeating the step up to a time that is sought."""

    def state(t):
        if t <= before:
            return y_before
        return solve_ivp(rate, (before, t), y_before, method=method, rtol=RTOL, atol=atol).y[:, -1]

    def value(t):
        return measure(t, state(t))

    last = value(at)
    if value(before) <= 0 or last >= 0:  # on the edge already, or only the interpolant was beyond
        t = before if last < 0 else at
    else:
        t = float(brentq(value, before, at, xtol=1e-18, rtol=1e-14))
    return t, state(t)
