"""Figures 20 and 21: from an actuator with a high frequency to its neighbour with a low one."""

from __future__ import annotations

from typing import Any, Final, NamedTuple

import numpy as np
from matplotlib.figure import Figure

from active_surface.paper.figure_result import MICRO, FigureResult, finish
from active_surface.paper.figures.coming_off import end_said, off_numbers, off_said
from active_surface.paper.figures.pairs import JUMPS, SURFACES, Paths, draw_plane, joined, legend, paths_of, reaches
from active_surface.paper.models import Bench
from active_surface.paper.parameters import Effort, Place
from active_surface.paper.path import Path
from active_surface.paper.share import share_of
from active_surface.paper.verdict import Answer, Verdict

AROUND: Final = 100e-6  # m beyond the actuators, from where parts are placed anywhere
OSCILLATIONS, LATE = 5.0, 1.0  # of the fast actuator, after which figure 20's part is with the slow one


class Handover(NamedTuple):
    """Which actuator has which frequency, and where the part begins."""

    frequencies: tuple[float, float]  # Hz, at (0, 0) and at (pitch, 0)
    start: Place  # m

    def target(self, pitch: float) -> Place:
        """Where [m] the slow actuator is."""
        return int(np.argmin(self.frequencies)) * pitch, 0.0


HANDOVERS: Final = {
    "20": Handover((300.0, 450.0), (100e-6, 0.0)),
    "21": Handover((400.0, 300.0), (-50e-6, 15e-6)),
}
STATEMENTS: Final = {
    "20": "From (100, 0) um the part leaves the 450 Hz actuator and converges to the 300 Hz one, 150 um away, on the "
    "line through both.",
    "21": "From (-50, 15) um the part leaves the 400 Hz actuator and converges to the 300 Hz one at (150, 0) um.",
}
LEFT_OPEN: Final = (
    "Which of the two stands at (0, 0) is not stated: the start is to lie in the region of the faster one, so that "
    "this one is at (150, 0). Read the other way some starts arrive: see the open points."
)


def find(bench: Bench, effort: Effort) -> FigureResult:
    """Both figures, and starts anywhere."""
    p = bench.parameters
    paths = {}
    for figure, one in HANDOVERS.items():
        drives = [bench.drive(frequency) for frequency in one.frequencies]
        paths[figure] = paths_of(bench, effort, drives, one.start, bench.duration(*drives))
    everywhere = {
        name: anywhere(bench, model, surface, bench.starts_of(model, effort))
        for name, (model, surface) in SURFACES.items()
    }
    shown = {f"figure {name}": (HANDOVERS[name], both) for name, both in paths.items()}
    shown["anywhere"] = (HANDOVERS["20"], everywhere)

    def draw(figure: Figure) -> None:
        axes = figure.subplots(len(shown), len(SURFACES), sharex=True, sharey=True)
        for i, (title, (one, both)) in enumerate(shown.items()):
            for k, (name, rows) in enumerate(both.items()):
                panel = axes[i, k]
                draw_plane(panel, rows, p.pitch, one.frequencies)
                said = f"{title}: {share_of(arrives(bench, one, path) for path in rows)} arrive"
                across, up = "x [µm]" if i == len(shown) - 1 else "", "y [µm]" if k == 0 else ""
                finish(panel, across, up, f"{name}\n{said}" if i == 0 else said, legend=False)
                panel.set_xlim(-MICRO * p.radius - 20, MICRO * (p.pitch + p.radius) + 20)
                panel.set_ylim(-MICRO * p.radius - 20, MICRO * p.radius + 20)
        legend(figure, slow=True)

    data: dict[str, Any] = {
        f"{title}: {name}": rows[0].drawn(800).tolist()
        for title, (_, both) in shown.items()
        for name, rows in both.items()
    }
    verdicts = [_arrives(bench, figure, paths[figure]) for figure in HANDOVERS]
    verdicts.insert(1, _in_five(bench, paths["20"]))
    verdicts.append(_anywhere(bench, everywhere))
    return FigureResult("fig20-21", "From a high to a low frequency", tuple(verdicts), data, draw, (15.5, 10.0),
                 "The paths from the stated starts, some others, and how all of them end.")  # fmt: skip


def anywhere(bench: Bench, model: str, surface: str, count: int) -> list[Path]:
    """Paths from places drawn around both actuators, with figure 20's frequencies; the same ones in every model."""
    p, one = bench.parameters, HANDOVERS["20"]
    random = np.random.default_rng(p.seed)
    places = random.uniform([-AROUND, -AROUND], [p.pitch + AROUND, AROUND], (count, 2))
    drives = [bench.drive(frequency) for frequency in one.frequencies]
    return bench.paths(model, drives, places, bench.duration(*drives), actuators=surface)


def arrives(bench: Bench, one: Handover, path: Path) -> bool:
    """Whether a part converges to the slow actuator."""
    p = bench.parameters
    return path.converged(1 / min(one.frequencies) / p.period_share, p.near, one.target(p.pitch))


def _arrives(bench: Bench, figure: str, paths: Paths) -> Verdict:
    p, one = bench.parameters, HANDOVERS[figure]
    places = [(0.0, 0.0), (p.pitch, 0.0)]
    answers: dict[str, Answer] = {}
    numbers: dict[str, Any] = {}
    for name, rows in paths.items():
        does = [arrives(bench, one, path) for path in rows]
        share, rim = share_of(does), share_of(path.over_rim for path in rows)
        numbers |= {
            f"share, {name}": share.value, f"over_the_rim, {name}": rim.value, f"starts, {name}": len(rows),
            f"unknown, {name}": share_of(path.unknown for path in rows).value,
            f"coming_off, {name}": off_numbers(rows, places), f"stated_start_arrives, {name}": does[0],
        }  # fmt: skip
        stated = "arrives" if does[0] else end_said(rows[0], places)
        more = f"{rim} go over the rim, {off_said(rows, places)}; the stated start {stated}"
        answers[name] = Answer(f"{share}", share.met, more)
    why = f"Converged as in figure 17. {JUMPS}{LEFT_OPEN if figure == '20' else ''}".strip()
    return Verdict(figure, STATEMENTS[figure], joined(answers), why, numbers)


def cycles_until_there(bench: Bench, one: Handover, path: Path) -> float:
    """How many cycles the fast actuator has made when the part comes into the slow one's region; inf: it never does."""
    p = bench.parameters
    return reaches(path, one.target(p.pitch), p.pitch) * max(one.frequencies) * p.period_share


def _in_five(bench: Bench, paths: Paths) -> Verdict:
    answers: dict[str, Answer] = {}
    numbers: dict[str, Any] = {}
    for name, rows in paths.items():
        cycles = np.array([cycles_until_there(bench, HANDOVERS["20"], path) for path in rows])
        come, soon = share_of(np.isfinite(cycles)), share_of(np.abs(cycles - OSCILLATIONS) <= LATE)
        text, more = f"{soon}", f"{come} get there"
        if come.hits:
            more += f", half of these within {np.median(cycles[np.isfinite(cycles)]):.1f} cycles"
        numbers |= {f"share, {name}": soon.value, f"get_there, {name}": come.value}
        numbers[f"cycles_of_the_stated_start, {name}"] = float(cycles[0])
        answers[name] = Answer(text, soon.met, more)
    return Verdict(
        "20 (five cycles)", "After five oscillations of the fast actuator the part is in the slow one's region.",
        joined(answers), f"When it is first nearer than half a pitch to the slow actuator; {OSCILLATIONS:g} cycles, "
        f"give or take {LATE:g}. It may leave again.", numbers,
    )  # fmt: skip


def _anywhere(bench: Bench, paths: Paths) -> Verdict:
    one = HANDOVERS["20"]
    answers: dict[str, Answer] = {}
    numbers: dict[str, Any] = {}
    for name, rows in paths.items():
        share, rim, off = (
            share_of(does)
            for does in (
                [arrives(bench, one, path) for path in rows],
                [path.over_rim for path in rows],
                [path.came_off for path in rows],
            )
        )
        numbers[name] = {"share": share.value, "over_the_rim": rim.value, "come_off": off.value, "starts": len(rows)}
        answers[name] = Answer(f"{share}", share.met, f"{rim} go over the rim, {off} come off")
    return Verdict(
        "VI-C (anywhere)", "A part that is placed anywhere on the workcell leaves the high frequency and "
        "converges to the "
        "low one.", joined(answers),
        f"At rest, drawn evenly from the rectangle that reaches {MICRO * AROUND:g} um beyond both actuators, "
        "with figure "
        f"20's frequencies. {JUMPS}Parts that friction holds where they are placed do not arrive.".strip(), numbers,
    )  # fmt: skip
