"""Figures 3, 4 and 11 to 14, in which nothing is chance: a part on a platform, and one stroke of one actuator."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any, Final, NamedTuple

import numpy as np
from scipy.stats import linregress

from active_surface.arrays import FloatArray
from active_surface.paper.bench import CLOSED, MODELS, PAPER, Bench, Path, Place
from active_surface.paper.picture import GREEN, GREY, LOOK, MICRO, MILLI, Curve, Found, Panel, dots, look
from active_surface.paper.statements import SLIP, STICK
from particle import (
    ConstantFriction,
    Drive,
    EventKind,
    HermiteDrive,
    KogutEtsion,
    Micropart,
    SurfaceMotion,
    Trajectory,
    platform_surface,
    simulate,
)
from particle.friction import Contact

SCHEMES: Final = {PAPER: "paper", CLOSED: "events"}
END, PIECES = 4.0, 400  # s, and of the platform's motion
STILL: Final = 0.01  # of the platform's largest speed: a relative velocity that counts as zero
SWING_STEP: Final = 1e-4  # s, of the paper's scheme, as the platform swings for seconds
RAMP_END, RAMP = 1e-2, 3.0  # s, and times the limit that the load along the surface rises to
STARTS: Final[tuple[Place, ...]] = ((170.08e-6, 170.08e-6), (200e-6, 100e-6))  # m, and off the diagonal
FREQUENCY: Final = 1600.0  # Hz: a cycle takes 0.625 ms, after which the surface is flat and rests
RADIAL_DURATION, SLOWING_DURATION = 3e-3, 5e-3  # s
TOLERANCE: Final = 1e-12
SLOW: Final = 1e-3  # of the largest speed, below which no ratio is taken
GRAVITY: Final = 9.80665  # m/s^2
Motion = Callable[[FloatArray], tuple[FloatArray, FloatArray, FloatArray]]


class Platform(NamedTuple):
    """A motion of figure 4's platform, which is not stated, and the friction that makes it slip at 2.41 s."""

    name: str
    motion: Motion  # position, velocity and acceleration [m, s] at times (n,)
    limit: float  # m/s^2


def _cubic(t: FloatArray, rate: float = 6.25) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Velocity t^3 sin(rate t) [m/s], with its integral and its derivative."""
    s, c = np.sin(rate * t), np.cos(rate * t)
    place = -(t**3) * c / rate + 3 * t**2 * s / rate**2 + 6 * t * c / rate**3 - 6 * s / rate**4
    return place, t**3 * s, 3 * t**2 * s + rate * t**3 * c


def _linear(t: FloatArray, rate: float = 3.2) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Position t sin(rate t) [m] with two derivatives."""
    s, c = np.sin(rate * t), np.cos(rate * t)
    return t * s, s + rate * t * c, 2 * rate * c - rate**2 * t * s


PLATFORMS: Final = (
    Platform("velocity t^3 sin(6.25 t)", _cubic, 59.403),
    Platform("position t sin(3.2 t)", _linear, 23.524),
)
"""The first does what the paper says and is judged; the second shows what that rests on."""


def friction_logic(bench: Bench) -> Found:
    """Figures 3 and 4. There is no plate: both schemes are asked."""
    p = bench.parameters
    limit = float(p.friction.friction_limit(p.mass * p.gravity))
    numbers: dict[str, dict[str, Any]] = {"3": {}, "4": {}, "4 (reversals)": {}}
    ramps, times = [], np.linspace(0, END, 401)
    for model in SCHEMES:
        load, friction = _ramp(bench, limit / p.mass, model)
        wrong = float(np.abs(friction - np.minimum(load, limit)).max() / limit)
        numbers["3"][model] = {"friction_limit": limit, "largest_difference": wrong}
        ramps.append(Curve(load * 1e9, friction * 1e9, LOOK[model] | {"label": f'"{SCHEMES[model]}"'}))
    panels = [Panel("load along the surface [nN]", "friction [nN]", ramps, "figure 3")]
    for platform in PLATFORMS:
        velocity, curves = platform.motion(times)[1], []
        for model in SCHEMES:
            swing = _swing(bench, model, platform)
            name = model if platform is PLATFORMS[0] else f"{platform.name}: {model}"
            numbers["4"][name] = slips_of(swing)._asdict()
            numbers["4 (reversals)"][name] = _zeros(platform, swing)
            relative = swing.at(times).velocity[:, 0]
            curves.append(Curve(times, relative, LOOK[model] | {"label": f'part to platform, "{SCHEMES[model]}"'}))
        part = velocity + relative
        curves.insert(0, Curve(times, velocity, {"color": GREY, "linewidth": 1.0, "label": "platform"}))
        curves.insert(1, Curve(times, part, {"color": GREEN, "linestyle": "-.", "linewidth": 1.2, "label": "part"}))
        grey = [("x", SLIP, SLIP, GREY), ("x", STICK, STICK, GREY), ("y", 0.0, 0.0, GREY)]
        panels.append(Panel("time [s]", "velocity [m/s]", curves, f"figure 4: platform with {platform.name}", grey))
    return numbers, [panels]


class Slips(NamedTuple):
    """When [s] a part first slips, is at rest against the platform and slips again, nan: never."""

    slips: float
    sticks: float
    again: float
    turns: bool  # whether it then goes the other way


def slips_of(swing: Trajectory) -> Slips:
    """The first slips of a part on a platform. A part that reverses slips again at once."""
    slips = [event.time for event in swing.events if event.kind is EventKind.SLIPS]
    stops = [event.time for event in swing.events if event.kind is EventKind.STOPS]
    turns = [event.time for event in swing.events if event.kind is EventKind.REVERSES]
    first = [*slips, np.nan][0]
    stick = min([time for time in stops + turns if time > first], default=np.nan)
    again = stick if stick in turns else min([time for time in slips if time > stick], default=np.nan)
    if not np.isfinite(again):
        return Slips(first, stick, again, False)
    rests = [time for time in stops + turns if time > again]
    moments = (first + stick) / 2, (again + min(rests, default=swing.time[-1])) / 2
    before, after = swing.at(moments).velocity[:, 0]
    return Slips(first, stick, again, bool(before * after < 0))


def reversals(motion: Motion) -> FloatArray:
    """When [s] the platform's velocity changes its sign."""
    times = np.linspace(1e-6, END, 40001)
    velocity = motion(times)[1]
    k = np.flatnonzero(velocity[:-1] * velocity[1:] < 0)
    return np.asarray(times[k] - velocity[k] * (times[k + 1] - times[k]) / (velocity[k + 1] - velocity[k]))


def zero_after_each(swing: Trajectory, times: FloatArray) -> bool:
    """Whether the relative velocity becomes zero once after each of the times (n,) [s]; before the first slip it is."""
    rests = np.array([e.time for e in swing.events if e.kind in (EventKind.STOPS, EventKind.REVERSES)])
    slips = min((event.time for event in swing.events if event.kind is EventKind.SLIPS), default=np.inf)
    spans = zip(times, [*times[1:], np.inf], strict=True)
    return all(begin < slips or ((rests > begin) & (rests <= until)).sum() == 1 for begin, until in spans)


def _zeros(platform: Platform, swing: Trajectory) -> dict[str, Any]:
    times = reversals(platform.motion)
    fastest = float(np.abs(platform.motion(np.linspace(0, END, 4001))[1]).max())
    relative = swing.at(times).velocity[:, 0]
    return {
        "reversals": times.tolist(),
        "relative_velocity": relative.tolist(),
        "after": zero_after_each(swing, times),
        "there": bool((np.abs(relative) < STILL * fastest).all()),
    }


def _ramp(bench: Bench, limit: float, model: str) -> tuple[FloatArray, FloatArray]:
    """The load along a platform whose acceleration grows steadily past a limit [m/s^2], and the friction on it [N]."""
    p, rate = bench.parameters, RAMP * limit / RAMP_END

    def motion(t: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        return rate * t**3 / 6, rate * t**2 / 2, rate * t

    surface = platform_surface(x=HermiteDrive.of(motion, RAMP_END, 20), size=rate * RAMP_END**3 / 6)
    path = _ridden(bench, model, surface, p.friction, RAMP_END, p.time_step)
    times = np.linspace(0, RAMP_END, 201)[1:-1]
    return p.mass * rate * times, path.at(times).friction_force


def _swing(bench: Bench, model: str, platform: Platform) -> Trajectory:
    """The part on a platform that swings ever more widely."""
    surface = platform_surface(x=HermiteDrive.of(platform.motion, END, PIECES), size=END)
    law = ConstantFriction(platform.limit * bench.parameters.mass)
    return _ridden(bench, model, surface, law, END, SWING_STEP)


def _ridden(bench: Bench, model: str, platform: SurfaceMotion, law: Contact, end: float, step: float) -> Trajectory:
    """The path of a part that begins at rest on a platform."""
    p, steps = bench.parameters, step if model == PAPER else None
    return simulate(
        platform, Micropart(p.mass, (0.0, 0.0)), law, end, p.gravity, scheme=SCHEMES[model], time_step=steps
    )


def radial(bench: Bench) -> Found:
    """Figures 11 and 12, and the same from a start that is not on the diagonal."""
    numbers: dict[str, dict[str, Any]] = {"11": {}, "12": {}}
    speeds: list[list[Curve]] = [[], []]
    ways: list[Curve] = []
    drive = bench.drive(FREQUENCY, cycles=1)
    for model in MODELS:
        paths = bench.paths(model, [drive], STARTS, RADIAL_DURATION, tolerance=TOLERANCE)
        both = list(zip(paths, STARTS, strict=True))
        numbers["11"][model] = {"ratio": max(_ratio(*one) for one in both)}
        numbers["12"][model] = {"bend": max(_bend(*one) for one in both)}
        for k, (path, start) in enumerate(both):
            rows, ratio = path.drawn(), start[0] / start[1]
            times, velocity = MILLI * rows[:, 0], path.trajectory.at(rows[:, 0]).velocity
            speeds[k].append(Curve(times, velocity[:, 0], look(model, "x, {}")))
            if model == CLOSED:
                mark = dots(".", GREEN, f"y times {ratio:g}, our equations", 6)
                speeds[k].append(Curve(times[::12], ratio * velocity[::12, 1], mark))
            ways.append(Curve(MICRO * rows[:, 1], MICRO * rows[:, 2], LOOK[model] if k else look(model)))
    for k, start in enumerate(STARTS):
        x, y = MICRO * start[0], MICRO * start[1]
        ways.append(Curve([0, x], [0, y], {"color": "#b0b0b0", "linewidth": 0.7, "zorder": 0}))
        ways.append(Curve([x], [y], dots("o", "black", "" if k else "starts", 6, markerfacecolor="none")))
    ways.append(Curve([0], [0], dots("^", "black", "actuator", 9, markerfacecolor="white")))
    panels = [
        Panel("time [ms]", "velocity [m/s]", curves, f"figure 11, from ({MICRO * x:g}, {MICRO * y:g}) µm")
        for curves, (x, y) in zip(speeds, STARTS, strict=True)
    ]
    near = {"xlim": (-20, 260), "ylim": (-20, 260), "aspect": "equal"}
    panels.append(Panel("x [µm]", "y [µm]", ways, "figure 12; grey: the line through the actuator", settings=near))
    return numbers, [panels]


def _ratio(path: Path, start: Place) -> float:
    """By how much the ratio of the velocities differs from that of the start's coordinates, relative."""
    v = path.trajectory.velocity
    if not path.trajectory.path_length:
        return np.inf  # it does not move
    fast = np.hypot(*v.T) > SLOW * np.hypot(*v.T).max()
    return float(np.abs(v[fast, 1] / v[fast, 0] / (start[1] / start[0]) - 1).max())


def _bend(path: Path, start: Place) -> float:
    """The largest distance from the line through start and actuator, over the way gone."""
    x, y = path.place.T
    if not path.trajectory.path_length:
        return np.inf
    away = np.abs(x * start[1] - y * start[0]) / np.hypot(*start)
    return float(away.max() / path.trajectory.path_length)


def deceleration(bench: Bench) -> Found:
    """Figures 13 and 14: after one stroke friction alone brings the part to rest, with the preset and with Table 1."""
    p, drive = bench.parameters, bench.drive(FREQUENCY, cycles=1)
    numbers: dict[str, Any] = {}
    curves: list[list[Curve]] = [[], []]
    for model in MODELS:
        paths = bench.paths(model, [drive], STARTS, SLOWING_DURATION)
        numbers[model] = slowing(paths, drive)
        for k, path in enumerate(paths):
            times = path.drawn()[:, 0]
            speed = np.hypot(*path.trajectory.at(times).velocity.T)
            curves[k].append(Curve(MILLI * times, speed, look(model)))
    held, heavy = Drive(p.stroke, FREQUENCY, cycle="up"), Bench(replace(p, gravity=GRAVITY))
    numbers["held_up"] = slowing(bench.paths(CLOSED, [held], STARTS, SLOWING_DURATION), held)
    numbers["with_gravity"] = slowing(heavy.paths(CLOSED, [drive], STARTS, SLOWING_DURATION), drive)
    preset, table = (float(law.friction_limit(0.0)) / p.mass for law in (p.friction, KogutEtsion()))
    moved = bench.paths(CLOSED, [drive], STARTS, SLOWING_DURATION, friction=KogutEtsion())
    by_table = {
        "at_zero_load": table,
        "preset_at_zero_load": preset,
        "distance": [path.trajectory.distance for path in moved],
    }
    end = MILLI / drive.frequency
    panels = [
        Panel("time [ms]", "velocity [m/s]", own, f"figure {name}", [("x", end, end, GREY)], legend=False)
        for name, own in zip(("13", "14"), curves, strict=True)
    ]
    return {"13, 14": numbers, "13, 14 (Table 1)": {PAPER: by_table}}, [panels]


def slowing(paths: list[Path], drive: Drive) -> dict[str, list[float]]:
    """How parts slow down once the drive has come to its end; nan for one that rests then or has come off.

    "rate": the deceleration [m/s^2] of the line through the speeds, "straight": how much of their variance it explains.
    """
    found: dict[str, list[float]] = {"rate": [], "straight": []}
    for path in paths:
        begin, rest = 1 / drive.frequency, path.trajectory.at_rest_since
        end = float(path.trajectory.time[-1] if rest is None else rest)
        rate = straight = float("nan")
        if end > begin:
            times = np.linspace(begin, end, 202)[1:-1]
            line = linregress(times, np.hypot(*path.trajectory.at(times).velocity.T))
            rate, straight = -float(line.slope), float(line.rvalue**2)
        found["rate"].append(rate)
        found["straight"].append(straight)
    return found
