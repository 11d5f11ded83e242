"""Figures 3 and 4: friction against the load along the surface, and a part on a platform that swings.

There is no plate. Both schemes are asked; the third model is the second one here.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from active_surface.arrays import FloatArray
from active_surface.paper.figure_result import LOOK, FigureResult, finish
from active_surface.paper.models import CLOSED, PAPER, Bench
from active_surface.paper.parameters import Effort
from active_surface.paper.verdict import Answer, Verdict, of_checks
from particle import ConstantFriction, EventKind, HermiteDrive, Micropart, Trajectory, platform_surface, simulate

SCHEMES: Final = {PAPER: "paper", CLOSED: "events"}
SLIP, STICK, WITHIN = 2.41, 2.87, 0.02  # s, the paper's times, and how near counts
END, PIECES = 4.0, 400  # s, and of the platform's motion
STILL: Final = 0.01  # of the platform's largest speed: a relative velocity that counts as zero
SWING_STEP: Final = 1e-4  # s, of the paper's scheme, as the platform swings for seconds
RAMP_END = 1e-2  # s
RAMP: Final = 3.0  # times the limit that the load along the surface rises to
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


def find(bench: Bench, effort: Effort) -> FigureResult:
    """Both figures."""
    ramps = {model: _ramp(bench, scheme) for model, scheme in SCHEMES.items()}
    swings = [{model: _swing(bench, scheme, one) for model, scheme in SCHEMES.items()} for one in PLATFORMS]
    data: dict[str, Any] = {
        "load": {m: load.tolist() for m, (load, _) in ramps.items()},
        "friction": {m: friction.tolist() for m, (_, friction) in ramps.items()},
    }
    times = np.linspace(0, END, 401)
    data["time"] = times.tolist()
    for one, both in zip(PLATFORMS, swings, strict=True):
        relative = {model: swing.at(times).velocity[:, 0].tolist() for model, swing in both.items()}
        data[one.name] = {"platform_velocity": one.motion(times)[1].tolist(), "relative_velocity": relative}

    def draw(figure: Figure) -> None:
        axes = figure.subplots(1, 3, width_ratios=(1, 1.4, 1.4))
        for model, (load, friction) in ramps.items():
            axes[0].plot(load * 1e9, friction * 1e9, **LOOK[model], label=f'"{SCHEMES[model]}"')
        finish(axes[0], "load along the surface [nN]", "friction [nN]", "figure 3")
        for panel, one in zip(axes[1:], PLATFORMS, strict=True):
            _draw_swing(panel, times, one, data[one.name])

    verdicts = (_logic(bench, ramps), *_swinging(swings))
    return FigureResult("fig3-4", "Friction logic", verdicts, data, draw, (13.5, 4.4),
                 "Friction against the load along the surface, and velocities on two swinging platforms; grey lines: "
                 "the paper's 2.41 and 2.87 s.")  # fmt: skip


def _draw_swing(axes: Axes, times: FloatArray, platform: Platform, own: dict[str, Any]) -> None:
    velocity = np.array(own["platform_velocity"])
    for moment in (SLIP, STICK):
        axes.axvline(moment, color="#b0b0b0", linewidth=0.8)
    axes.axhline(0, color="#b0b0b0", linewidth=0.8)
    axes.plot(times, velocity, color="#8a8a8a", linewidth=1.0, label="platform")
    part = velocity + own["relative_velocity"][CLOSED]
    axes.plot(times, part, color="#3d8a4e", linestyle="-.", linewidth=1.2, label="part")
    for model, values in own["relative_velocity"].items():
        axes.plot(times, values, **LOOK[model], label=f'part to platform, "{SCHEMES[model]}"')
    finish(axes, "time [s]", "velocity [m/s]", f"figure 4: {platform.name}")


def _logic(bench: Bench, ramps: dict[str, tuple[FloatArray, FloatArray]]) -> Verdict:
    limit = float(bench.parameters.friction.friction_limit(bench.parameters.mass * bench.parameters.gravity))
    answers, numbers = {}, {"friction_limit": limit}
    for model, (load, friction) in ramps.items():
        expected = np.minimum(load, limit)
        wrong = float(np.abs(friction - expected).max() / limit)
        numbers[f"largest_difference_{model}"] = wrong
        answers[model] = of_checks(f"to {wrong:.0e} of the limit", [wrong < 1e-2])
    return Verdict(
        "3", "Friction equals the load along the surface until the limit, and stays at the limit while the part "
        "slides.",
        answers, "No plate is in it: a part on a platform whose acceleration grows steadily.", numbers,
    )  # fmt: skip


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


def _swinging(swings: list[dict[str, Trajectory]]) -> tuple[Verdict, Verdict]:
    slides: dict[str, Answer] = {}
    turns: dict[str, Answer] = {}
    numbers: dict[str, Any] = {}
    for model in SCHEMES:
        own = [_slide(swing[model]) for swing in swings]
        slides[model] = own[0]._replace(more=f"with the {PLATFORMS[1].name}: {own[1].text}")
        zeros = [_zeros(one, swing[model]) for one, swing in zip(PLATFORMS, swings, strict=True)]
        turns[model] = zeros[0]._replace(more=f"{zeros[0].more}; with the {PLATFORMS[1].name}: {zeros[1].more}")
    for one, swing in zip(PLATFORMS, swings, strict=True):
        times = reversals(one.motion)
        numbers[one.name] = {"reversals": times.tolist()} | {
            model: slips_of(path)._asdict() | {"relative_velocity": path.at(times).velocity[:, 0].tolist()}
            for model, path in swing.items()
        }
    return (
        Verdict(
            "4", "The part slips from 2.41 s; at 2.87 s it sticks for a moment, and then slides the other way.", slides,
            f"The platform's motion and friction are not stated. With the {PLATFORMS[0].name} and "
            f"{PLATFORMS[0].limit:g} m/s^2, which were chosen for both times, the part slides on at once, as in the "
            "paper. A reversal without rest counts as sticking for a moment: a part that is brought to rest by "
            "friction while the platform pulls harder than friction holds must do so.", numbers,
        ),
        Verdict(
            "4 (reversals)", "The relative velocity becomes zero at every reversal of the platform's velocity.", turns,
            "Two readings, each half of it: once after every reversal of the platform and before the next, and at the "
            f"very moment, where zero is less than {100 * STILL:g} % of the platform's largest speed. A part that "
            "slides has its own velocity at that moment, as the paper's own straight lines have.", numbers,
        ),
    )  # fmt: skip


def _slide(swing: Trajectory) -> Answer:
    results = slips_of(swing)
    pause = results.again - results.sticks
    text = f"slips {results.slips:.3f}, sticks {results.sticks:.3f} s"
    text += f" for {pause:.2f} s" if pause > 0 else ""
    text += "" if results.turns else ", goes on the same way"
    in_time = [abs(results.slips - SLIP) < WITHIN, abs(results.sticks - STICK) < WITHIN]
    return of_checks(text, [*in_time, pause < WITHIN, results.turns])


def _zeros(platform: Platform, swing: Trajectory) -> Answer:
    times = reversals(platform.motion)
    fastest = float(np.abs(platform.motion(np.linspace(0, END, 4001))[1]).max())
    relative = swing.at(times).velocity[:, 0]
    after, there = zero_after_each(swing, times), bool((np.abs(relative) < STILL * fastest).all())
    turning = [f"{v:.2f} m/s at {t:.2f} s" for t, v in zip(times.tolist(), relative.tolist(), strict=True)]
    text = f"{'once' if after else 'not once'} after each, {'and' if there else 'not'} at it"
    return of_checks(text, [after, there], ", ".join(turning))


def _ramp(bench: Bench, scheme: str) -> tuple[FloatArray, FloatArray]:
    """The load along a platform whose acceleration grows steadily, and the friction on the part [N]."""
    p = bench.parameters
    limit = float(p.friction.friction_limit(p.mass * p.gravity)) / p.mass
    rate = RAMP * limit / RAMP_END

    def motion(t: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        return rate * t**3 / 6, rate * t**2 / 2, rate * t

    drive = HermiteDrive.of(motion, RAMP_END, 20)
    size = float(motion(np.array([RAMP_END]))[0][0])
    surface = platform_surface(x=drive, size=size)
    step = p.time_step if scheme == "paper" else None
    part = Micropart(p.mass, (0.0, 0.0))
    times = np.linspace(0, RAMP_END, 201)[1:-1]
    path = simulate(surface, part, p.friction, RAMP_END, p.gravity, scheme=scheme, time_step=step)
    return p.mass * rate * times, path.at(times).friction_force


def _swing(bench: Bench, scheme: str, platform: Platform) -> Trajectory:
    """The part on a platform that swings ever more widely."""
    p = bench.parameters
    surface = platform_surface(x=HermiteDrive.of(platform.motion, END, PIECES), size=END)
    step = SWING_STEP if scheme == "paper" else None
    part = Micropart(p.mass, (0.0, 0.0))
    law = ConstantFriction(platform.limit * p.mass)
    return simulate(surface, part, law, END, p.gravity, scheme=scheme, time_step=step)
