"""Figures 3 and 4: friction against the load along the surface, and a part on a platform that swings.

There is no plate. Both schemes are asked; the third model is the second one here.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

import numpy as np
from matplotlib.figure import Figure

from paper.found import LOOK, Found, finish
from paper.models import CLOSED, PAPER, Bench, FloatArray
from paper.parameters import Effort
from paper.verdict import Answer, Verdict, of_checks
from particle import EventKind, HermiteDrive, Micropart, Trajectory, platform_surface, simulate

NAMES = ("fig3", "fig4")
SCHEMES: Final = {PAPER: "paper", CLOSED: "events"}
SLIP, STICK, WITHIN = 2.41, 2.87, 0.02  # s, the paper's times, and how near counts
END, PIECES = 4.0, 400  # s, and of the platform's motion
SWING_STEP: Final = 1e-4  # s, of the paper's scheme, as the platform swings for seconds
RAMP_END = 1e-2  # s
RAMP: Final = 3.0  # times the limit that the load along the surface rises to


def find(bench: Bench, effort: Effort) -> Found:
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

    return Found("fig3-4", "Friction logic", (_logic(bench, ramps), _swinging(swings)), data, draw, (11.5, 4.2),
                 "Friction against the load along the surface, and velocities on a swinging platform.")  # fmt: skip


def _logic(bench: Bench, ramps: dict[str, tuple[FloatArray, FloatArray]]) -> Verdict:
    limit = float(bench.parameters.friction.friction_limit(bench.parameters.mass * bench.parameters.gravity))
    answers, numbers = {}, {"friction_limit": limit}
    for model, (load, friction) in ramps.items():
        wanted = np.minimum(load, limit)
        wrong = float(np.abs(friction - wanted).max() / limit)
        numbers[f"largest_difference_{model}"] = wrong
        answers[model] = of_checks(f"it does, to {wrong:.0e} of the limit", [wrong < 1e-2])
    return Verdict(
        "3", "Friction equals the load along the surface until the limit, and stays at the limit while the part "
        "slides.",
        answers, "No plate is in it: a part on a platform whose acceleration grows steadily.", numbers,
    )  # fmt: skip


def _swinging(swings: dict[str, Trajectory]) -> Verdict:
    answers: dict[str, Answer] = {}
    numbers: dict[str, Any] = {}
    for model, swing in swings.items():
        slips = [event.time for event in swing.events if event.kind is EventKind.SLIPS]
        stops = [e.time for e in swing.events if e.kind in (EventKind.STOPS, EventKind.REVERSES)]
        slip, again = [*slips, np.nan, np.nan][:2]
        stick = [*stops, np.nan][0]
        before, after = (float(swing.at([time]).velocity[0, 0]) for time in ((slip + stick) / 2, END))
        numbers |= {f"slip_{model}": slip, f"stick_{model}": stick, f"slips_again_{model}": again}
        near = [abs(slip - SLIP) < WITHIN, abs(stick - STICK) < WITHIN]
        answers[model] = of_checks(
            f"slips {slip:.3f} s, sticks {stick:.3f} s, for {again - stick:.2f} s, then the other way",
            [*near, again - stick < WITHIN, before * after < 0],
        )
    return Verdict(
        "4", "The part slips from 2.41 s; at 2.87 s it sticks for a moment, and then slides the other way.", answers,
        "The platform's motion and friction are not stated. Of x = t sin(3.2 t) and 23.524 m/s^2 the second was chosen "
        "for 2.41 s; the second time is then a result. The part stays at rest on the platform while that turns, where "
        "the paper's slides on at once.", numbers,
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
