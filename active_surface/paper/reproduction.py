"""reproduce: figures of the paper, one after the other: found, drawn, written; of all of them a page as well."""

from __future__ import annotations

import csv
import json
import math
import re
from collections.abc import Callable, Mapping, Sequence
from importlib.resources import files
from io import StringIO
from pathlib import Path
from string import Template
from time import perf_counter
from typing import Any, Final, NamedTuple

from active_surface.paper.bench import MODELS, PARAMETERS, QUICK, Bench, Effort, Parameters
from active_surface.paper.dead_zones import dead_zones
from active_surface.paper.feasible_area import feasible_area
from active_surface.paper.one_actuator import accuracy, convergence, translocation
from active_surface.paper.picture import FigureResult, Found, draw
from active_surface.paper.statements import STATEMENTS
from active_surface.paper.strokes import deceleration, friction_logic, radial
from active_surface.paper.threshold import threshold
from active_surface.paper.two_actuators import handover, neighbours
from active_surface.paper.verdict import NOT, PARTLY, REPRODUCED, SAME, Share, Verdict
from coupling import Progress, silent, whole_file

FIGURES: Final[dict[tuple[str, ...], Callable[[Bench], Found]]] = {
    ("fig3", "fig4"): friction_logic,
    ("fig5", "fig6"): feasible_area,
    ("fig11", "fig12"): radial,
    ("fig13", "fig14"): deceleration,
    ("fig15",): translocation,
    ("fig16",): neighbours,
    ("fig17", "fig19"): convergence,
    ("fig18",): threshold,
    ("fig20", "fig21"): handover,
    ("fig22",): accuracy,
    ("deadzones",): dead_zones,
}
"""What computes them, by the names of figures that share a picture, in the order of the page."""
ALL: Final = "all"
FOLDER, PAGE, TABLE = "paper", "paper.md", "verdicts.csv"
COLUMNS = ("scheme", "ours", "plate")  # of the page, by MODELS
SAID = {REPRODUCED: "**yes**", PARTLY: "partly", NOT: "**no**"}


class Reproduction(NamedTuple):
    """What was found, and where it was written."""

    results: tuple[FigureResult, ...]
    files: tuple[Path, ...]
    seconds: float

    @property
    def verdicts(self) -> list[Verdict]:
        """Of all figures."""
        return [verdict for one in self.results for verdict in one.verdicts]


def figures_of(names: Sequence[str]) -> list[tuple[str, ...]]:
    """The groups of FIGURES that names ask for, each once, in their order; "all" or nothing: every one.

    "fig17", "17", "17a" and "figure 17" are the same.
    Raises ValueError, naming every name that there is no figure of, as it was given.
    """
    known = [name for group in FIGURES for name in group]
    plain = [re.sub(r"^(?:fig\.?|figure)?\s*(\d+)[ab]?$", r"fig\1", name.strip().lower()) for name in names or [ALL]]
    if wrong := [f'"{name}"' for name, one in zip(names, plain, strict=False) if one not in (*known, ALL)]:
        which = f"among {', '.join(known)} or all (1, 2 and 7 to 10 are drawings)"
        raise ValueError(f"Figures must be {which}; got {', '.join(wrong)}")
    return [group for group in FIGURES if ALL in plain or set(plain) & set(group)]


def reproduce(
    names: Sequence[str] = (),
    output: str | Path | None = None,
    effort: Effort = QUICK,
    parameters: Parameters = PARAMETERS,
    progress: Progress = silent,
) -> Reproduction:
    """Reproduce figures of the paper.

    Parameters
    ----------
    names : sequence of str
        Names of the figures; empty: all.
    output : path, optional
        Folder for a picture and a JSON file of each figure. The page and a CSV file of its verdicts are written there,
        too, when all are reproduced with PARAMETERS.
    effort : Effort
        Numbers of starts, frequencies and places: `QUICK` or `FULL`.
    parameters : Parameters
        What the paper states, and what it leaves open.
    progress : Progress, optional
        Reports the progress of each figure, for progress bars.

    Raises
    ------
    ValueError
        There is no figure of a name.
    """
    groups = figures_of(names)
    begun, bench = perf_counter(), Bench(parameters, effort)
    results: list[FigureResult] = []
    written: list[Path] = []
    for group in groups:
        with progress(f"Reproducing {', '.join(group)}"):
            results.append(found_of(group, bench))
        if output is not None:
            written += write(results[-1], Path(output) / FOLDER)
    seconds = perf_counter() - begun
    if output is not None and len(groups) == len(FIGURES) and parameters is PARAMETERS:
        written += [Path(output) / FOLDER / TABLE, Path(output) / PAGE]
        for file, text in zip(written[-2:], (table_of(results), page_of(results, effort)), strict=True):
            with whole_file(file) as partial:
                partial.write_text(text, encoding="utf-8")
    return Reproduction(tuple(results), tuple(written), seconds)


def found_of(group: tuple[str, ...], bench: Bench) -> FigureResult:
    """What is found of a group of FIGURES."""
    return FigureResult("-".join(group).replace("-fig", "-"), *FIGURES[group](bench))


def write(found: FigureResult, folder: Path) -> list[Path]:
    """Writes NAME.png and NAME.json into a folder; returns them."""
    folder.mkdir(parents=True, exist_ok=True)
    picture, data = folder / f"{found.name}.png", folder / f"{found.name}.json"
    with whole_file(picture) as partial:
        draw(found).savefig(partial, dpi=90)
    whole = {"verdicts": [verdict.as_dict() for verdict in found.verdicts], "panels": found.data}
    with whole_file(data) as partial:
        partial.write_text(json.dumps(rounded(whole), allow_nan=False) + "\n")
    return [picture, data]


def rounded(value: Any) -> Any:
    """The same with numbers of seven digits, and None for what is none, as JSON knows no nan; of a share its value."""
    if isinstance(value, Share):
        return rounded(value.value)
    if isinstance(value, Mapping):
        return {str(key): rounded(own) for key, own in value.items()}
    if isinstance(value, (list, tuple)):
        return [rounded(own) for own in value]
    if isinstance(value, float):
        return float(f"{value:.7g}") if math.isfinite(value) else None
    return value


def page_of(results: Sequence[FigureResult], effort: Effort) -> str:
    """page.md with the verdicts on PARAMETERS; pictures and data are in FOLDER beside it."""
    verdicts = [verdict for one in results for verdict in one.verdicts]
    head = ["figure", "the paper", *COLUMNS, "found"]
    rows = [head, ["---"] * len(head)]
    for verdict in verdicts:
        said = [SAID[verdict.answers[model].verdict] if _judged(verdict, model) else "-" for model in MODELS]
        rows.append([verdict.figure, verdict.statement, *said, _found(verdict)])
    page = Template(files("active_surface.paper").joinpath("page.md").read_text("utf-8")).substitute(
        full=" --full" if effort.name == "full" else "",
        counted=counted(verdicts),
        starts=effort.starts,
        by_steps=effort.starts_by_steps,
        table="\n".join("| " + " | ".join(row) + " |" for row in rows),
    )
    return _typeset(page)


def table_of(results: Sequence[FigureResult]) -> str:
    """How every statement was judged, with the verdict and the numbers of each model, as CSV."""
    how = {one.figure: one.how for one in STATEMENTS}
    columns = [f"{name}: {column}" for name in MODELS.values() for column in ("verdict", "found")]
    rows = [["figure", "the paper", "how it is judged", *columns]]
    for verdict in (verdict for one in results for verdict in one.verdicts):
        rows.append([verdict.figure, verdict.statement, how[verdict.figure]])
        for model in MODELS:
            rows[-1] += [verdict.answers[model].verdict if _judged(verdict, model) else "-"]
            rows[-1] += [verdict.answers[model].text if model in verdict.answers else "-"]
    text = StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows)
    return _typeset(text.getvalue())


def counted(verdicts: Sequence[Verdict]) -> str:
    """How many statements hold in each model."""
    counts = []
    for model, name in MODELS.items():
        own = [one.answers[model].verdict for one in verdicts if model in one.answers and not one.beyond]
        counts.append(f"{name}, {own.count(REPRODUCED)} of {len(own)} ({own.count(PARTLY)} partly)")
    return f"Statements that hold: {'; '.join(counts)}."


def _judged(verdict: Verdict, model: str) -> bool:
    return model in verdict.answers and not verdict.beyond


def _found(verdict: Verdict) -> str:
    """By the paper's scheme, or by the first model that has something to do with the statement."""
    return next(answer.text for answer in verdict.answers.values() if answer.text != SAME)


def _typeset(text: str) -> str:
    return text.replace(" um", " µm").replace("m/s^2", "m/s²")
