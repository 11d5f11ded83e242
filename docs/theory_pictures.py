"""Two cases in linear and in von Karman's theory, side by side; the figures of docs/large-deflection.md.

.venv/bin/python docs/theory_pictures.py [CASE ...]

Not part of `make docs`: the paper's own case takes minutes where the plate stretches.
"""

import sys
from pathlib import Path

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray

from common import unit_for
from coupling import PlateSummary, Result, read_case, report, run_case
from coupling.case import Case
from coupling.pictures import draw_path, draw_plate, draw_window, path_window, portrait_of

DOCS = Path(__file__).parent
CASES = ("transport", "two_actuators")
THEORIES = {"linear": "Linear theory", "von-karman": "Von Karman's theory"}
AFTER = {False: ", at rest since", True: " at"}
MICRO, MILLI = 1e6, 1e3


def in_theory(case: Case, theory: str) -> Case:
    """The case with a plate that only bends, or also stretches."""
    return case.model_copy(update={"plate": case.plate.model_copy(update={"theory": theory})})


def end(summary: PlateSummary) -> str:
    """Where and when a run ended."""
    x, y = (MICRO * c for c in summary.end_position)
    since = summary.end_time if summary.at_rest_since is None else summary.at_rest_since
    return f"end ({x:.2f}, {y:.2f}) µm: {summary.outcome}{AFTER[summary.at_rest_since is None]} {MILLI * since:.4g} ms"


def outlines_at_ends(result: Result) -> NDArray[np.float64]:
    """The outlines (2, k, 2) [m] of a part's face at the start and at the end; of a point none."""
    face, path = result.case.part.face, result.trajectory
    if face is None or path.heading is None:
        return np.empty((0, 0, 2))
    return face.outline(path.position[[0, -1]], path.heading[[0, -1]])


def draw(results: list[Result]) -> Figure:
    """Both paths over their plates; short ones in windows of the same frame, beside the whole plate."""
    portraits = [portrait_of(result) for result in results]
    outlines = [outlines_at_ends(result) for result in results]
    both = np.concatenate([one.samples.position for one in portraits] + [some.reshape(-1, 2) for some in outlines])
    plate = portraits[0].plate
    assert plate is not None
    window = path_window(both, plate.outline.box, plate.actuators)
    frame = plate.frame if window is None else window
    figure = Figure(figsize=(12.0 if window is None else 17.0, 5.6), layout="constrained")
    FigureCanvasAgg(figure)
    panels = list(figure.subplots(1, 2 if window is None else 3, squeeze=False)[0])
    keys = []
    if window is not None:
        whole, unit = panels.pop(0), unit_for(plate.frame, "m")
        keys += draw_plate(whole, plate, unit, side="left")
        draw_window(whole, unit, window)
        whole.set_title(f"The plate at {portraits[0].when}\n{THEORIES['linear']}", fontsize=10)
    unit = unit_for(frame, "m")
    for axes, one, result, some in zip(panels, portraits, results, outlines, strict=True):
        assert one.plate is not None and isinstance(result.summary, PlateSummary)
        keys += draw_plate(axes, one.plate, unit, frame)
        keys = draw_path(axes, one.rows, one.samples.position, unit, frame) + keys
        for corners in some * unit.per_si:
            axes.fill(*corners.T, fill=False, linewidth=1.2, zorder=2.8)
        axes.set_title(
            f"{THEORIES[result.summary.theory]}, the plate at {one.when}\n{end(result.summary)}", fontsize=10
        )
    labelled = {key.get_label(): key for key in keys}
    figure.legend(handles=list(labelled.values()), loc="outside lower center", ncols=len(labelled), frameon=False)
    return figure


def main(names: list[str]) -> None:
    for name in names:
        case = read_case(DOCS.parent / f"examples/{name}.toml")
        results = [run_case(in_theory(case, theory)) for theory in THEORIES]
        for result in results:
            assert isinstance(result.summary, PlateSummary)
            print(name, result.summary.theory, end(result.summary), sep=": ")
            for label, text in report.lines(result.summary):
                print(f"{label:12}{text}")
            print(*(f"warning     {text}" for text in report.warnings(result.summary)), sep="\n", flush=True)
        draw(results).savefig(DOCS / f"{name}_theories.png", dpi=90)


if __name__ == "__main__":
    main(sys.argv[1:] or list(CASES))
