"""Figures 3 and 4: friction against the load along the surface, and a part on a platform that swings.

There is no plate. Both schemes are asked; the third model is the second one here.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final, NamedTuple

import numpy as np
from matplotlib.figure import Figure

from active_surface.arrays import FloatArray
from active_surface.paper.figure_result import LOOK, FigureResult, finish
from active_surface.paper.models import CLOSED, PAPER, Bench
from active_surface.paper.parameters import Effort
from active_surface.paper.verdict import Answer, Verdict, of_checks
from particle import EventKind, HermiteDrive, Micropart, Trajectory, platform_surface, simulate

SCHEMES: Final = {PAPER: "paper", CLOSED: "events"}
SLIP, STICK, WITHIN = 2.41, 2.87, 0.02  # s, the paper's times, and how near counts
END, PIECES = 4.0, 400  # s, and of the platform's motion
STILL: Final = 0.01  # of the platform's largest speed: a relative velocity that counts as zero
SWING_STEP: Final = 1e-4  # s, of the paper's scheme, as the platform swings for seconds
RAMP_END = 1e-2  # s
RAMP: Final = 3.0  # times the limit that the load along the surface rises to


def find(bench: Bench, effort: Effort) -> FigureResult:
    """Both figures."""
    ramps = {model: _ramp(bench, scheme) for model, scheme in SCHEMES.items()}
    swings = {model: _swing(bench, scheme) for model, scheme in SCHEMES.items()}
    p = bench.parameters
    data = {
        "load": {m: load.tolist() for m, (load, _) in ramps.items()},
        "friction": {m: friction.tolist() for m, (_, friction) in ramps.items()},
    }
    times = np.linspace(0, END, 401)
    velocity = _motion(p.platform_rate)(times)[1]
    data |= {"time": times.tolist(), "platform_velocity": velocity.tolist()}
    relative = {model: swing.at(times).velocity[:, 0] for model, swing in swings.items()}
    data |= {f"relative_velocity_{model}": values.tolist() for model, values in relative.items()}

    def draw(figure: Figure) -> None:
        left, right = figure.subplots(1, 2, width_ratios=(1, 1.5))
        for model, (load, friction) in ramps.items():
            left.plot(load * 1e9, friction * 1e9, **LOOK[model], label=f'"{SCHEMES[model]}"')
        finish(left, "load along the surface [nN]", "friction [nN]", "figure 3")
        right.plot(times, velocity, color="#8a8a8a", linewidth=1.0, label="platform")
        right.plot(times, velocity + relative[CLOSED], color="black", linestyle="-.", linewidth=1.2, label="part")
        for model, values in relative.items():
            right.plot(times, values, **LOOK[model], label=f'part to platform, "{SCHEMES[model]}"')
        finish(right, "time [s]", "velocity [m/s]", "figure 4")

    verdicts = (_logic(bench, ramps), *_swinging(swings, p.platform_rate))
    return FigureResult("fig3-4", "Friction logic", verdicts, data, draw, (11.5, 4.2),
                 "Friction against the load along the surface, and velocities on a swinging platform.")  # fmt: skip


def _logic(bench: Bench, ramps: dict[str, tuple[FloatArray, FloatArray]]) -> Verdict:
    limit = float(bench.parameters.friction.friction_limit(bench.parameters.mass * bench.parameters.gravity))
    answers, numbers = {}, {"friction_limit": limit}
    for model, (load, friction) in ramps.items():
        expected = np.minimum(load, limit)
        wrong = float(np.abs(friction - expected).max() / limit)
        numbers[f"largest_difference_{model}"] = wrong
        answers[model] = of_checks(f"off by {wrong:.0e} of the limit at most", [wrong < 1e-2])
    return Verdict(
        "3", "Friction equals the load along the surface until the limit, and stays at the limit while the part "
        "slides.",
        answers, "No plate is in it: a part on a platform whose acceleration grows steadily.", numbers,
    )  # fmt: skip


class Slips(NamedTuple):
    """When [s] a part first slips, sticks and slips again, nan: never, and whether it then goes the other way."""

    slips: float
    sticks: float
    again: float
    turns: bool


def slips_of(swing: Trajectory) -> Slips:
    """The first slips of a part on a platform."""
    slips = [event.time for event in swing.events if event.kind is EventKind.SLIPS]
    stops = [event.time for event in swing.events if event.kind in (EventKind.STOPS, EventKind.REVERSES)]
    first, again = [*slips, np.nan, np.nan][:2]
    stick = [*stops, np.nan][0]
    if not np.isfinite(again):
        return Slips(first, stick, again, False)
    rests = [time for time in stops if time > again]
    moments = (first + stick) / 2, (again + [*rests, swing.time[-1]][0]) / 2
    before, after = swing.at(moments).velocity[:, 0]
    return Slips(first, stick, again, bool(before * after < 0))


def reversals(rate: float) -> FloatArray:
    """When [s] the platform's velocity changes its sign."""
    times = np.linspace(1e-6, END, 40001)
    velocity = _motion(rate)(times)[1]
    k = np.flatnonzero(velocity[:-1] * velocity[1:] < 0)
    return np.asarray(times[k] - velocity[k] * (times[k + 1] - times[k]) / (velocity[k + 1] - velocity[k]))


def _swinging(swings: dict[str, Trajectory], rate: float) -> tuple[Verdict, Verdict]:
    slides: dict[str, Answer] = {}
    turns: dict[str, Answer] = {}
    times = reversals(rate)
    fastest = float(np.abs(_motion(rate)(np.linspace(0, END, 4001))[1]).max())
    numbers: dict[str, Any] = {"reversals": times.tolist()}
    for model, swing in swings.items():
        results = slips_of(swing)
        pause = results.again - results.sticks
        relative = swing.at(times).velocity[:, 0]
        numbers |= {f"slips_{model}": results._asdict(), f"relative_velocity_{model}": relative.tolist()}
        text = f"slips {results.slips:.3f} s, sticks {results.sticks:.3f} s, for {pause:.2f} s, then goes on "
        text += "the other way" if results.turns else "the same way"
        in_time = [abs(results.slips - SLIP) < WITHIN, abs(results.sticks - STICK) < WITHIN]
        slides[model] = of_checks(text, [*in_time, pause < WITHIN, results.turns])
        zero = np.abs(relative) < STILL * fastest
        turning = [f"{v:.2f} m/s at {t:.2f} s" for t, v in zip(times.tolist(), relative.tolist(), strict=True)]
        turns[model] = of_checks(", ".join(turning), [bool(zero.all())])
    return (
        Verdict(
            "4", "The part slips from 2.41 s; at 2.87 s it sticks for a moment, and then slides the other way.", slides,
            "The platform's motion and friction are not stated. Of x = t sin(3.2 t) and 23.524 m/s^2 the second was "
            "chosen for 2.41 s; the second time is then a result. The paper's part slides on at once.", numbers,
        ),
        Verdict(
            "4 (reversals)", "The relative velocity becomes zero at every reversal of the platform's velocity.", turns,
            f"Zero: below {100 * STILL:g} % of the platform's largest speed. A part that slides has its own velocity "
            "there, as the paper's own straight lines have.", numbers,
        ),
    )  # fmt: skip


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


def _motion(rate: float) -> Callable[[FloatArray], tuple[FloatArray, FloatArray, FloatArray]]:
    """x = t sin(rate t) [m] with two derivatives."""

    def motion(t: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        s, c = np.sin(rate * t), np.cos(rate * t)
        return t * s, s + rate * t * c, 2 * rate * c - rate**2 * t * s

    return motion


def _swing(bench: Bench, scheme: str) -> Trajectory:
    """The part on a platform that swings with a growing amplitude."""
    p = bench.parameters
    surface = platform_surface(x=HermiteDrive.of(_motion(p.platform_rate), END, PIECES), size=END)
    step = SWING_STEP if scheme == "paper" else None
    part = Micropart(p.mass, (0.0, 0.0))
    return simulate(surface, part, p.platform_friction, END, p.gravity, scheme=scheme, time_step=step)
