"""Figures 13 and 14: after one stroke friction alone brings the part to rest."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from matplotlib.figure import Figure

from paper.found import MILLI, Found, finish, look
from paper.models import MODELS, Bench, Path
from paper.parameters import Effort
from paper.radial import FREQUENCY, OFF_DIAGONAL, START, one_cycle
from paper.verdict import Answer, Verdict, of_checks
from particle import Drive, KogutEtsion

NAMES = ("fig13", "fig14")
STARTS: Final = {"13": START, "14": OFF_DIAGONAL}  # m
DURATION: Final = 5e-3  # s
STATED: Final = 20.9  # m/s^2
WITHIN: Final = 0.05  # of that
STRAIGHT: Final = 0.99  # of the variance that a line explains


def find(bench: Bench, effort: Effort) -> Found:
    """Both figures, with the preset and with the friction that Table 1 gives."""
    p = bench.parameters
    drive, held = one_cycle(p.stroke), Drive(p.stroke, FREQUENCY, cycle="up")
    preset, table = (float(law.friction_limit(0.0)) / p.mass for law in (p.friction, KogutEtsion()))
    shared: dict[str, Any] = {"stated": STATED, "preset_at_zero_load": preset, "table_1_at_zero_load": table}
    paths = {model: bench.paths(model, [drive], list(STARTS.values()), DURATION) for model in MODELS}
    raised = {model: bench.paths(model, [held], list(STARTS.values()), DURATION) for model in MODELS}
    moved = bench.paths("closed", [drive], list(STARTS.values()), DURATION, friction=KogutEtsion())
    shared["distance_with_table_1"] = [path.trajectory.distance for path in moved]
    verdicts = []
    for k, figure in enumerate(STARTS):
        answers: dict[str, Answer] = {}
        numbers = dict(shared)
        for model in MODELS:
            slowing, straight, low, high = later(paths[model][k], p.mass)
            up = later(raised[model][k], p.mass)[0]
            numbers |= {
                f"deceleration_{model}": slowing, f"deceleration_surface_held_up_{model}": up,
                f"straightness_{model}": straight, f"friction_over_mass_{model}": [low, high],
            }  # fmt: skip
            checks = [abs(slowing / STATED - 1) < WITHIN, straight > STRAIGHT, abs(preset / STATED - 1) < WITHIN]
            text = f"{slowing:.2f} m/s^2"
            answers[model] = of_checks(text, checks)
        verdicts.append(Verdict(
            figure, "After the stroke the velocity falls along a straight line, by 20.9 m/s^2, the value of "
            "equations (3) to (5).",
            answers, f"The preset was chosen to give {preset:.2f} m/s^2 at zero load; Table 1 gives {table:.0f} "
            "m/s^2, with which the part does not move at all. One value for both figures needs a flat surface, hence "
            "the stroke's return; where it is held up, gravity and curvature make "
            f"{numbers['deceleration_surface_held_up_closed']:.1f} m/s^2 of it.",
            numbers,
        ))  # fmt: skip

    drawn = {model: [path.drawn() for path in both] for model, both in paths.items()}

    def draw(figure: Figure) -> None:
        axes = figure.subplots(1, 2, sharey=True)
        for k, name in enumerate(STARTS):
            for model, both in drawn.items():
                speed = np.hypot(*paths[model][k].trajectory.at(both[k][:, 0]).velocity.T)
                axes[k].plot(MILLI * both[k][:, 0], speed, **look(model))
            axes[k].axvline(MILLI / FREQUENCY, color="#8a8a8a", linewidth=0.8)
            finish(axes[k], "time [ms]", "velocity [m/s]", f"figure {name}", legend=k == 0)

    data: dict[str, Any] = {"numbers": shared, "starts": {name: list(start) for name, start in STARTS.items()}}
    data |= {model: [rows.tolist() for rows in both] for model, both in drawn.items()}
    return Found("fig13-14", "Friction during motion", tuple(verdicts), data, draw, (11.0, 4.2),
                 "Speed over time after one cycle at 1.6 kHz, which ends at the grey line.")  # fmt: skip


def later(path: Path, mass: float) -> tuple[float, float, float, float]:
    """After the stroke: deceleration [m/s^2] of the line through the speeds, how much of their variance it explains,
    and the least and the largest friction over mass [m/s^2]."""
    trajectory = path.trajectory
    rest = trajectory.at_rest_since
    end = float(trajectory.time[-1] if rest is None else rest)
    times = np.linspace(1 / FREQUENCY, end, 202)[1:-1]
    if end <= 1 / FREQUENCY:
        return (float("nan"),) * 4
    samples = trajectory.at(times)
    speed = np.hypot(*samples.velocity.T)
    slope, level = np.polyfit(times, speed, 1)
    left = float(((speed - slope * times - level) ** 2).sum() / ((speed - speed.mean()) ** 2).sum())
    friction = samples.friction_force / mass
    return -float(slope), 1 - left, float(friction.min()), float(friction.max())
