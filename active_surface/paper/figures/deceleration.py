"""Figures 13 and 14: after one stroke friction alone brings the part to rest."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Final, NamedTuple

import numpy as np
from matplotlib.figure import Figure

from active_surface.paper.figure_result import MILLI, FigureResult, finish, look
from active_surface.paper.figures.radial import FREQUENCY, OFF_DIAGONAL, START, one_cycle
from active_surface.paper.models import CLOSED, MODELS, PAPER, Bench
from active_surface.paper.parameters import Effort
from active_surface.paper.path import Path
from active_surface.paper.verdict import Answer, Verdict, of_checks
from particle import Drive, KogutEtsion

STARTS: Final = {"13": START, "14": OFF_DIAGONAL}  # m
DURATION: Final = 5e-3  # s
GRAVITY: Final = 9.80665  # m/s^2
STATED: Final = 20.9  # m/s^2
AS_STATED: Final = 0.05  # m/s^2, half of the last digit stated
STRAIGHT: Final = 0.99  # of the variance that a line explains


class Slowing(NamedTuple):
    """The line through the speeds after the stroke; nan where the part rests then or has come off."""

    rate: float  # m/s^2, its deceleration
    straight: float  # how much of their variance it explains
    least: float  # m/s^2, friction over mass
    most: float


def find(bench: Bench, effort: Effort) -> FigureResult:
    """Both figures, with the preset, and what other readings and the friction of Table 1 give."""
    p = bench.parameters
    drive = one_cycle(bench)
    paths = {model: slowing_paths(bench, model, drive) for model in MODELS}
    results = {model: [slowing(path, p.mass, drive) for path in both] for model, both in paths.items()}
    verdicts = (_slows(bench, results), _value(bench))
    drawn = {model: [path.drawn() for path in both] for model, both in paths.items()}

    def draw(figure: Figure) -> None:
        axes = figure.subplots(1, 2, sharey=True)
        for k, name in enumerate(STARTS):
            for model, both in drawn.items():
                speed = np.hypot(*paths[model][k].trajectory.at(both[k][:, 0]).velocity.T)
                axes[k].plot(MILLI * both[k][:, 0], speed, **look(model))
            axes[k].axvline(MILLI / drive.frequency, color="#8a8a8a", linewidth=0.8)
            finish(axes[k], "time [ms]", "velocity [m/s]", f"figure {name}", legend=k == 0)

    data: dict[str, Any] = {"starts": {name: list(start) for name, start in STARTS.items()}}
    data |= {model: [rows.tolist() for rows in both] for model, both in drawn.items()}
    return FigureResult("fig13-14", "Friction during motion", verdicts, data, draw, (11.0, 4.2),
                 "Speed over time after one cycle at 1.6 kHz, which ends at the grey line.")  # fmt: skip


def slowing_paths(bench: Bench, model: str, drive: Drive) -> list[Path]:
    """The paths of figures 13 and 14 with a drive."""
    return bench.paths(model, [drive], list(STARTS.values()), DURATION)


def slowing(path: Path, mass: float, drive: Drive) -> Slowing:
    """How the part slows down once the drive has come to its end, after one pass."""
    trajectory = path.trajectory
    begin, rest = 1 / drive.frequency, trajectory.at_rest_since
    end = float(trajectory.time[-1] if rest is None else rest)
    if end <= begin:
        return Slowing(*[float("nan")] * 4)
    times = np.linspace(begin, end, 202)[1:-1]
    samples = trajectory.at(times)
    speed = np.hypot(*samples.velocity.T)
    slope, level = np.polyfit(times, speed, 1)
    left = float(((speed - slope * times - level) ** 2).sum() / ((speed - speed.mean()) ** 2).sum())
    friction = samples.friction_force / mass
    return Slowing(-float(slope), 1 - left, float(friction.min()), float(friction.max()))


def _others(bench: Bench) -> tuple[list[Slowing], list[Slowing]]:
    """The same on the closed form with one stroke up, held there, and up and down with gravity."""
    p = bench.parameters
    held, drive = Drive(p.stroke, FREQUENCY, cycle="up"), one_cycle(bench)
    weighty = Bench(replace(p, gravity=GRAVITY))
    return (
        [slowing(path, p.mass, held) for path in slowing_paths(bench, CLOSED, held)],
        [slowing(path, p.mass, drive) for path in slowing_paths(weighty, CLOSED, drive)],
    )


def slows_as_stated(bench: Bench, model: str, drive: Drive) -> float:
    """The share of both starts that slow down along a line by the stated value."""
    both = [slowing(path, bench.parameters.mass, drive) for path in slowing_paths(bench, model, drive)]
    return sum(one.straight > STRAIGHT and abs(one.rate - STATED) < AS_STATED for one in both) / len(both)


def _slows(bench: Bench, results: dict[str, list[Slowing]]) -> Verdict:
    answers: dict[str, Answer] = {}
    held, weighty = _others(bench)
    numbers: dict[str, Any] = {
        "held_up": [one._asdict() for one in held], "with_gravity": [one._asdict() for one in weighty],
    }  # fmt: skip
    for model, both in results.items():
        numbers[model] = [one._asdict() for one in both]
        straight = min(one.straight for one in both)
        same = abs(both[0].rate - both[1].rate) < AS_STATED
        stated = all(abs(one.rate - STATED) < AS_STATED for one in both)
        more = f"a line explains {100 * straight:.2f} % of the variance"
        answers[model] = of_checks(f"{_both(both)} m/s^2", [straight > STRAIGHT, same, stated], more)
    return Verdict(
        "13, 14", "After the stroke the velocity falls along a straight line, by 20.9 m/s^2 from both starts.", answers,
        "The straight line and the one value are results. The value is not: the preset's plasticity index was chosen "
        "for it. It holds without weight, as the paper's forces have none, and up and down in 1/f: with gravity the "
        f"velocities fall by {_both(weighty)} m/s^2, held up after one stroke by {_both(held)}.", numbers,
    )  # fmt: skip


def _both(results: list[Slowing]) -> str:
    return " and ".join(f"{one.rate:.2f}" for one in results)


def _value(bench: Bench) -> Verdict:
    p = bench.parameters
    preset, table = (float(law.friction_limit(0.0)) / p.mass for law in (p.friction, KogutEtsion()))
    moved = bench.paths(CLOSED, [one_cycle(bench)], list(STARTS.values()), DURATION, friction=KogutEtsion())
    far = [path.trajectory.distance for path in moved]
    numbers = {"preset_at_zero_load": preset, "table_1_at_zero_load": table, "distance_with_table_1": far}
    text = f"{table:.0f} m/s^2, {'moves' if any(far) else 'the part does not move'}"
    return Verdict(
        "13, 14 (Table 1)", "The deceleration of 20.9 m/s^2 is the value of equations (3) to (5) with Table 1.",
        {PAPER: of_checks(text, [abs(table - STATED) < AS_STATED])},
        f"No surface is in it. The preset has {preset:.2f} m/s^2 at zero load because its plasticity index was chosen "
        "for that: that all models slow down by this value shows that they agree with the preset, not with the paper.",
        numbers,
    )  # fmt: skip
