"""reproduce: figures of the paper, one after the other: found, drawn, written; of all of them a page as well."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Callable, Mapping, Sequence
from importlib.resources import files
from pathlib import Path
from string import Template
from time import perf_counter
from typing import Any, Final, NamedTuple

from active_surface.paper.bench import MODELS, PAPER, PARAMETERS, QUICK, Bench, Effort, Parameters
from active_surface.paper.dead_zones import dead_zones
from active_surface.paper.feasible_area import feasible_area
from active_surface.paper.one_actuator import accuracy, convergence, translocation
from active_surface.paper.picture import FigureResult, Found, draw
from active_surface.paper.strokes import deceleration, friction_logic, radial
from active_surface.paper.threshold import threshold
from active_surface.paper.two_actuators import handover, neighbours
from active_surface.paper.verdict import BEYOND, NOT, PARTLY, REPRODUCED, Share, Verdict
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
FOLDER, PAGE = "paper", "paper.md"
SAID = {REPRODUCED: "**yes**", PARTLY: "partly", NOT: "**no**", BEYOND: "-"}


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
        Folder for a picture and a JSON file of each figure, and for the page when all are reproduced with PARAMETERS.
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
        written.append(Path(output) / PAGE)
        with whole_file(written[-1]) as partial:
            partial.write_text(page_of(results, effort))
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
    head = ["figure", "the paper", "verdict", *MODELS.values()]
    rows = [head, ["---"] * len(head)]
    for verdict in verdicts:
        cells = [_cell(verdict, model) for model in MODELS]
        rows.append([verdict.figure, verdict.statement, SAID[verdict.verdict], *cells])
    page = Template(files("active_surface.paper").joinpath("page.md").read_text()).substitute(
        full=" --full" if effort.name == "full" else "",
        counted=counted(verdicts),
        starts=effort.starts,
        by_steps=effort.starts_by_steps,
        table="\n".join("| " + " | ".join(row) + " |" for row in rows),
    )
    return page.replace(" um", " µm").replace("m/s^2", "m/s²")


def counted(verdicts: Sequence[Verdict]) -> str:
    """How many statements hold in each model."""
    counts = []
    for model, name in MODELS.items():
        own = [one.answers[model].verdict for one in verdicts if model in one.answers and not one.beyond]
        counts.append(f"{name}, {own.count(REPRODUCED)} of {len(own)} ({own.count(PARTLY)} partly)")
    return f"Statements that hold: {'; '.join(counts)}."


def _cell(verdict: Verdict, model: str) -> str:
    if model not in verdict.answers:
        return "-"
    answer = verdict.answers[model]
    return answer.text if verdict.beyond or model == PAPER else f"{SAID[answer.verdict]}: {answer.text}"
