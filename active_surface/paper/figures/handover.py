"""Figures 20 and 21: from an actuator with a high frequency to its neighbour with a low one."""

from __future__ import annotations

from typing import Any, Final, NamedTuple

import numpy as np
from matplotlib.figure import Figure

from active_surface.paper.figure_result import LOOK, MICRO, MILLI, FigureResult, finish
from active_surface.paper.figures.coming_off import end_said, off_numbers, off_said
from active_surface.paper.figures.pairs import JUMPS, SURFACES, WIDTHS, Paths, draw_plane, joined, paths_of, reaches
from active_surface.paper.models import Bench
from active_surface.paper.parameters import Effort, Place
from active_surface.paper.path import Path
from active_surface.paper.share import share_of
from active_surface.paper.verdict import Answer, Verdict

PLOTTED: Final = 40.0  # ms
OSCILLATIONS, WITHIN = 5.0, 1.0  # of the fast actuator, after which figure 20's part is with the slow one


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
    """Both figures."""
    p = bench.parameters
    paths = {figure: paths_of(bench, effort, *one, p.cycles) for figure, one in HANDOVERS.items()}
    drawn = {figure: {name: rows[0].drawn(800) for name, rows in both.items()} for figure, both in paths.items()}

    def draw(figure: Figure) -> None:
        axes = figure.subplots(2, 2)
        for (over_time, plane), (name, rows) in zip(axes, drawn.items(), strict=True):
            for key, row in rows.items():
                model, surface = SURFACES[key]
                style: dict[str, Any] = LOOK[model] | {"linewidth": WIDTHS[surface]}
                over_time.plot(MILLI * row[:, 0], MICRO * row[:, 1], **style, label=key)
            for place in (0.0, p.pitch):
                over_time.axhline(MICRO * place, color="#8a8a8a", linewidth=0.7)
            finish(over_time, "time [ms]", "x [µm]", f"figure {name}", legend=False)
            over_time.set_xlim(0, PLOTTED)
            draw_plane(plane, rows, p.pitch)
            finish(plane, "x [µm]", "y [µm]", legend=False)
        handles, names = axes[0, 0].get_legend_handles_labels()
        figure.legend(handles, names, loc="outside lower center", ncols=len(names), frameon=False, fontsize=9)

    data: dict[str, Any] = {
        f"{figure}: {name}": rows.tolist() for figure, both in drawn.items() for name, rows in both.items()
    }
    verdicts = [_arrives(bench, figure, paths[figure]) for figure in HANDOVERS]
    verdicts.insert(1, _in_five(bench, paths["20"]))
    return FigureResult("fig20-21", "From a high to a low frequency", tuple(verdicts), data, draw, (12.5, 8.0),
                 "The paths from the stated starts; crosses: their ends.")  # fmt: skip


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
        answers[name] = Answer(
            f"{share} arrive, {rim} go over the rim, {off_said(rows, places)}; the stated start {stated}", share.met
        )
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
        come, soon = share_of(np.isfinite(cycles)), share_of(np.abs(cycles - OSCILLATIONS) <= WITHIN)
        text = f"{come} get there"
        if come.hits:
            text += f", half of these within {np.median(cycles[np.isfinite(cycles)]):.1f} cycles; {soon} after five"
        numbers |= {f"share, {name}": soon.value, f"get_there, {name}": come.value}
        numbers[f"cycles_of_the_stated_start, {name}"] = float(cycles[0])
        answers[name] = Answer(text, soon.met)
    return Verdict(
        "20 (five cycles)", "After five oscillations of the fast actuator the part is in the slow one's region.",
        joined(answers), f"When it is first nearer than half a pitch to the slow actuator; {OSCILLATIONS:g} cycles, "
        f"give or take {WITHIN:g}. It may leave again.", numbers,
    )  # fmt: skip
