"""Figures 20 and 21: from an actuator with a high frequency to its neighbour with a low one."""

from __future__ import annotations

from typing import Any, Final, NamedTuple

import numpy as np
from matplotlib.figure import Figure

from paper.found import LOOK, MICRO, MILLI, Found, finish, percent
from paper.models import Bench, Path
from paper.pairs import JUMPS, SURFACES, WIDTHS, draw_plane, joined, paths_of
from paper.parameters import Effort, Place
from paper.verdict import Answer, Verdict, of_share

NAMES = ("fig20", "fig21")
SHOWN: Final = 40.0  # ms


class Handover(NamedTuple):
    """One figure: which actuator has which frequency, and where the part begins."""

    figure: str
    frequencies: tuple[float, float]  # Hz, at (0, 0) and at (pitch, 0)
    start: Place  # m
    statement: str
    left_open: str


HANDOVERS: Final = (
    Handover(
        "20",
        (300.0, 450.0),
        (100e-6, 0.0),
        "From (100, 0) um the part leaves the 450 Hz actuator and converges to the 300 Hz one, 150 um away, on the "
        "line through both.",
        "Which of the two stands at (0, 0) is not stated: the start is to lie in the region of the faster one, so that "
        "this one is at (150, 0). Read the other way some starts arrive: see the open points.",
    ),
    Handover(
        "21",
        (400.0, 300.0),
        (-50e-6, 15e-6),
        "From (-50, 15) um the part leaves the 400 Hz actuator and converges to the 300 Hz one at (150, 0) um.",
        "",
    ),
)


def find(bench: Bench, effort: Effort) -> Found:
    """Both figures."""
    p = bench.parameters
    paths: dict[str, dict[str, list[Path]]] = {}
    for one in HANDOVERS:
        drives = [bench.drive(frequency) for frequency in one.frequencies]
        paths[one.figure] = paths_of(bench, effort, drives, one.start, p.cycles / min(one.frequencies))
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
            over_time.set_xlim(0, SHOWN)
            draw_plane(plane, rows, p.pitch)
            finish(plane, "x [µm]", "y [µm]", legend=False)
        handles, names = axes[0, 0].get_legend_handles_labels()
        figure.legend(handles, names, loc="outside lower center", ncols=len(names), frameon=False, fontsize=9)

    data: dict[str, Any] = {
        f"{figure}: {name}": rows.tolist() for figure, both in drawn.items() for name, rows in both.items()
    }
    verdicts = tuple(_verdict(bench, one, paths[one.figure]) for one in HANDOVERS)
    return Found("fig20-21", "From a high to a low frequency", verdicts, data, draw, (12.5, 8.0),
                 "The paths from the stated starts; crosses: their ends.")  # fmt: skip


def _verdict(bench: Bench, one: Handover, paths: dict[str, list[Path]]) -> Verdict:
    p = bench.parameters
    slow = int(np.argmin(one.frequencies))
    target = (slow * p.pitch, 0.0)
    answers: dict[str, Answer] = {}
    numbers: dict[str, Any] = {}
    for name, rows in paths.items():
        arrives = [path.converged(1 / min(one.frequencies), p.near, target) for path in rows]
        share = float(np.mean(arrives))
        gone = float(np.mean([not path.attached for path in rows]))
        numbers |= {f"share, {name}": share, f"gone, {name}": gone, f"starts, {name}": len(rows)}
        numbers[f"stated start arrives, {name}"] = bool(arrives[0])
        first = "it does" if arrives[0] else "it does not"
        answers[name] = of_share(
            f"{percent(share)} arrive, {percent(gone)} are gone; from the stated start {first}", share
        )
    why = f"Converged as in figure 17. Gone: over the rim or off the surface. {JUMPS}{one.left_open}".strip()
    return Verdict(one.figure, one.statement, joined(answers), why, numbers)
