"""A part on a moving surface, integrated a second time: scipy's solvers, events by root finding, closed forms.

With r(X, t) the place in space of the centre of mass above the surface's point X, r_0 that of the contact and n the
normal, Newton's law in the coordinates X of the surface is

    free = r'' at X'' = 0, less gravity,  N = m n.free + squeeze,  pull = -(free - (n.free) n)
    at rest while the q along the surface with J^T q = (dr/dX)^T pull has |q| <= static ratio Q(N)/m,  J = dr_0/dX
    sliding: (dr/dX)^T (dr/dX) X'' = (dr/dX)^T pull - (Q/m) J^T J X'/|J X'|

(d'Alembert: pressure does no work in a displacement dX, friction does Q J dX). A point on a surface that moves
upwards, `Point`, has r = r_0 = (X + base, w); `top_face` lifts both off the mid-plane. Sliding is DOP853 in (X, X').
Where |X'| is small compared with friction times a stroke, it is either

- on its way to rest: with dt = u ds, u = |X'|, the equations in (t, X, ln u, n = X'/u) are regular,
  (ln u)' = n.X'', n' = X'' - (n.X'') n, and u falls exponentially in s; or
- just off: the direction relaxes at the rate Q/(m u), and Radau takes (X, X') from a speed of 1e-13 m/s.

In flight the centre of mass is thrown, the squeeze acts straight down, and X is the point whose r lies above or below
it; the part lands where r meets it. Everything that ends a piece is located by repeating the last step, not by its
interpolant. Slow: seconds a case. With RTOL or FIRST_SPEED smaller still, the ends of the reference cases move by less
than 2e-11 of the plate's radius.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np
from located_steps import march
from motion_problem import Path, Problem, force, size_of
from scipy.integrate import DOP853, Radau
from scipy.optimize import brentq

LENGTH_ERROR, SPEED_ERROR = 1e-18, 1e-16  # of one step; m, m/s (a plate is 1e-4 m wide)
FIRST_SPEED, LAST_SPEED = 1e-13, 1e-14  # m/s
HEAT_ERROR = 1e-18  # J/kg
SCAN = 1000  # moments of a span at which a part at rest or in flight is looked at


def trace(problem: Problem, position: Sequence[float], velocity: Sequence[float], duration: float) -> Path:
    """The path up to `duration`, or to where the part comes off (unless it flies) or leaves the plate."""
    y, time, events = np.array([*position, *velocity, 0.0], float), 0.0, []  # X, X', dissipated [J/kg]

    def note(kind: str) -> None:
        events.append((kind, time, *y[:2].tolist()))

    def path() -> Path:
        f = force(problem, time, y[:2], y[2:4]).frame
        v = f.velocity + f.centre @ y[2:4] if thrown is None else thrown(time)[1]
        return Path(time, y[:2], y[2:4], events, problem.mass * y[4], problem.mass * (v @ v) / 2)

    edges = np.unique([0.0, *(k for k in problem.breakpoints if 0 < k < duration), duration])
    mode, thrown = "slide" if y[2:4].any() else "rest", None
    for end in edges[1:].tolist():
        while time < end:
            if mode == "rest":
                time, found = rest(problem, time, end, y[:2])
            elif mode == "fly":
                time, y, found = fly(problem, thrown, time, end, y)
            else:
                if mode == "off":
                    f = force(problem, time, y[:2], np.zeros(2))
                    along = f.gives()
                    y[2:4] = FIRST_SPEED * along / size_of(along)
                time, y, found = slide(problem, time, end, y, mode == "off")
            if found == "leaves" or (found == "detaches" and not problem.flies):
                note(found)
                return path()
            if found == "slips":
                note("slips")
                mode = "off"
            elif found == "at rest":
                y[2:4] = 0.0
                f = force(problem, time, y[:2], y[2:4])
                held = f.needed() <= problem.static_ratio * f.limit
                note("stops" if held else "reverses")
                mode = "rest" if held else "off"
            elif found == "detaches":
                note("detaches")
                mode, thrown = "fly", throw(problem, time, y)
            elif found == "lands":
                y = land(problem, thrown, time, y)
                note("lands")
                mode, thrown = "slide" if y[2:4].any() else "rest", None
                if force(problem, time, y[:2], y[2:4]).load < -problem.pull_off:
                    note("detaches")
                    mode, thrown = "fly", throw(problem, time, y)
            elif mode == "off":  # it is fast enough by now, or a breakpoint came: its velocity is all there is to know
                mode = "slide"
    return path()


def first(measures: Sequence[tuple[str, Callable[[float], float]]], values: np.ndarray, moments: np.ndarray):
    """The first (moment, kind) at which a measure, `values` (k, n) at these moments (n,), falls below zero."""
    found = []
    for (kind, measure), row in zip(measures, values, strict=True):
        # A part that has just come to rest, or that rested up to a breakpoint, is held there but for rounding.
        below = np.flatnonzero(row < -1e-9 * max(1.0, float(np.abs(row).max())))
        if len(below):
            k = below[0]
            before = moments[max(k - 1, 0)]
            late = k == 0 or row[k - 1] <= 0
            found.append((float(before if late else brentq(measure, before, moments[k], xtol=1e-18, rtol=1e-15)), kind))
    return min(found) if found else None


def rest(problem: Problem, time: float, end: float, place: np.ndarray) -> tuple[float, str]:
    """Until the pull exceeds friction or the load pull-off."""

    def margins(moment: float) -> tuple[float, float]:
        f = force(problem, moment, place, np.zeros(2))
        return problem.static_ratio * f.limit - f.needed(), f.load + problem.pull_off

    moments = np.linspace(time, end, SCAN)
    values = np.array([margins(moment) for moment in moments]).T
    measures = [("slips", lambda t: margins(t)[0]), ("detaches", lambda t: margins(t)[1])]
    kinds = 2 if problem.pull_off < math.inf else 1
    return first(measures[:kinds], values[:kinds], moments) or (end, "")


def throw(problem: Problem, start: float, y: np.ndarray) -> Callable[[float], tuple[np.ndarray, np.ndarray]]:
    """Place and velocity of the centre of mass of a part that comes off, over time."""
    f = problem.surface(y[0], y[1], start).frame(y[2:4])
    place, velocity = f.place, f.velocity + f.centre @ y[2:4]
    down = np.array(problem.gravity) - [0.0, 0.0, problem.squeeze / problem.mass]

    def at(time: float) -> tuple[np.ndarray, np.ndarray]:
        s = time - start
        return place + s * velocity + s * s / 2 * down, velocity + s * down

    return at


def under(problem: Problem, place: np.ndarray, time: float, guess: np.ndarray) -> tuple[np.ndarray, float]:
    """The X whose r lies under or over a place, by Newton's method from a guess, and the height over it."""
    point = guess.copy()
    for _ in range(50):
        f = problem.surface(point[0], point[1], time).frame(np.zeros(2))
        off = np.linalg.solve(f.centre[:2], place[:2] - f.place[:2])
        point += off
        if size_of(off) < 1e-17:
            return point, float(place[2] - f.place[2] - f.centre[2] @ off)
    raise RuntimeError("no point under the part")


def fly(problem: Problem, thrown: Callable, time: float, end: float, y: np.ndarray) -> tuple[float, np.ndarray, str]:
    """Until the part lands; the measures are scaled to the flight's largest height."""

    def over(moment: float, guess: np.ndarray) -> tuple[np.ndarray, float]:
        return under(problem, thrown(moment)[0], moment, guess)

    moments, points, heights = np.linspace(time, end, SCAN), [y[:2]], [0.0]
    for moment in moments[1:]:
        point, height = over(moment, points[-1])
        points.append(point)
        heights.append(height)
        if height < 0 or problem.gap(*point) < 0:
            break
    else:
        return end, np.array([*points[-1], 0.0, 0.0, y[4]]), ""
    guess, before = points[-2], moments[len(points) - 2]
    if heights[-1] >= 0:
        kind, measure = "leaves", lambda t: problem.gap(*over(t, guess)[0])
    else:
        kind, measure = "lands", lambda t: over(t, guess)[1]
    if measure(before) <= 0:
        raise RuntimeError("a flight shorter than the scan resolves")
    time = float(brentq(measure, before, moment, xtol=1e-18, rtol=1e-15))
    return time, np.array([*over(time, guess)[0], 0.0, 0.0, y[4]]), kind


def land(problem: Problem, thrown: Callable, time: float, y: np.ndarray) -> np.ndarray:
    """The impact: the normal velocity is lost, and of that along the surface `impact` times as much."""
    f = problem.surface(y[0], y[1], time).frame(np.zeros(2))
    relative = thrown(time)[1] - f.velocity
    into = relative @ f.normal
    along = f.centre.T @ (relative - into * f.normal)
    most, mass, slips = problem.impact * abs(into), f.centre.T @ f.centre, f.contact.T @ f.contact
    v = np.zeros(2)
    if along @ np.linalg.solve(slips, along) > most**2:  # else friction's impulse brings the contact to rest
        v = np.linalg.solve(mass, along)
        for _ in range(200):
            v = np.linalg.solve(mass + most / size_of(f.contact @ v) * slips, along)
    kept = f.centre @ v
    return np.array([*y[:2], *v, y[4] + (relative @ relative - kept @ kept) / 2])


def slide(problem: Problem, time: float, end: float, y: np.ndarray, off: bool) -> tuple[float, np.ndarray, str]:
    """Until the end, rest, detachment or the rim; `off`: begins with Radau, and ends where that is no longer needed."""

    def rate(moment: float, y: np.ndarray) -> np.ndarray:
        f = force(problem, moment, y[:2], y[2:4])
        return np.array([*y[2:4], *f.acceleration(y[2:4]), f.heats(y[2:4])])

    def speed_left(moment: float, y: np.ndarray) -> float:
        """Over the speed below which friction would stop it in a hundredth of a stroke."""
        return size_of(y[2:4]) - 0.01 * force(problem, moment, y[:2], y[2:4]).limit * problem.stroke_time

    def gain(moment: float, y: np.ndarray) -> float:
        """Negative where it slows down by more than rounding."""
        f = force(problem, moment, y[:2], y[2:4])
        return y[2:4] @ f.acceleration(y[2:4]) / size_of(y[2:4]) + 1e-3 * f.limit

    def contact(moment: float, y: np.ndarray) -> float:
        return force(problem, moment, y[:2], y[2:4]).load + problem.pull_off

    def inside(moment: float, y: np.ndarray) -> float:
        return problem.gap(y[0], y[1])

    atol = np.array([LENGTH_ERROR, LENGTH_ERROR, SPEED_ERROR, SPEED_ERROR, HEAT_ERROR])
    ends = [("leaves", inside)] + ([("detaches", contact)] if problem.pull_off < math.inf else [])
    if off:
        fast = ("fast", lambda moment, y: -speed_left(moment, y))
        # From the moment on: its steps may be shorter than the rounding of a time.
        later = [(kind, lambda s, y, of=measure: of(time + s, y)) for kind, measure in [*ends, fast, ("slow", gain)]]
        s, y, found = march(Radau, lambda s, y: rate(time + s, y), 0.0, y, end - time, atol, later, first_step=1e-13)
        if found != "slow":
            return (time + s if found else end), y, found
        return to_rest(problem, time + s, end, y, ends)
    if speed_left(time, y) > 0:
        t, y, found = march(DOP853, rate, time, y, end, atol, [*ends, ("slow", speed_left)])
        if found != "slow":
            return t, y, found
        time = t
    return to_rest(problem, time, end, y, ends)


def to_rest(problem: Problem, time: float, end: float, y: np.ndarray, ends: list) -> tuple[float, np.ndarray, str]:
    """The regular form, z = (t, X, ln u, n, dissipated)."""

    def rate(_: float, z: np.ndarray) -> np.ndarray:
        u, n = math.exp(z[3]), z[4:6] / size_of(z[4:6])  # 1 but for errors, which grow where it moves against the pull
        f = force(problem, z[0], z[1:3], u * n)
        a = f.acceleration(n)
        return np.array([u, *(u * u * n), n @ a, *(a - (n @ a) * n), u * u * f.heats(n)])

    def plain(z: np.ndarray) -> np.ndarray:
        return np.array([*z[1:3], *(math.exp(z[3]) * z[4:6]), z[6]])

    u = size_of(y[2:4])
    fast = math.log(max(4 * u, 0.04 * force(problem, time, y[:2], y[2:4]).limit * problem.stroke_time))
    stops = [(kind, lambda _, z, of=measure: of(z[0], plain(z))) for kind, measure in ends]
    stops += [
        ("", lambda _, z: end - z[0]),
        ("at rest", lambda _, z: z[3] - math.log(LAST_SPEED)),
        ("fast", lambda _, z: fast - z[3]),  # it did not come to rest: a turn
    ]
    z = np.array([time, *y[:2], math.log(u), *(y[2:4] / u), y[4]])
    atol = np.array([1e-18, LENGTH_ERROR, LENGTH_ERROR, 1e-13, 1e-13, 1e-13, HEAT_ERROR])
    _, z, found = march(DOP853, rate, 0.0, z, math.inf, atol, stops)
    return (end if found == "" else z[0]), plain(z), "" if found == "fast" else found
