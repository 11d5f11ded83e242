"""reproduce: figures of the paper, one after the other: found, drawn, written; of all of them a page as well."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from pathlib import Path
from time import perf_counter
from typing import Any, NamedTuple

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from active_surface.paper.catalogue import MODULES, finder, modules_of
from active_surface.paper.figure_result import FigureResult
from active_surface.paper.models import Bench
from active_surface.paper.page import page_of
from active_surface.paper.parameters import PARAMETERS, QUICK, Effort, Parameters
from active_surface.paper.verdict import Verdict
from coupling import Progress, silent, whole_file

FOLDER, PAGE = "paper", "paper.md"
READINGS = "readings.json"  # of `reproduce readings`, whose summary the page repeats


class Reproduction(NamedTuple):
    """What was found, and where it was written."""

    results: tuple[FigureResult, ...]
    files: tuple[Path, ...]
    seconds: float

    @property
    def verdicts(self) -> list[Verdict]:
        """Of all figures."""
        return [verdict for one in self.results for verdict in one.verdicts]


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
        Folder for a picture and a JSON file of each figure, and for the page when all are reproduced.
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
    modules = modules_of(names)
    begun, bench = perf_counter(), Bench(parameters)
    results: list[FigureResult] = []
    files: list[Path] = []
    for module in modules:
        with progress(f"Reproducing {', '.join(MODULES[module])}"):
            one = finder(module)(bench, effort)
        results.append(one)
        if output is not None:
            files += write(one, Path(output) / FOLDER)
    seconds = perf_counter() - begun
    if output is not None and len(modules) == len(MODULES):
        page = Path(output) / PAGE
        replace_file(page, page_of(results, effort, parameters, FOLDER, builder_of(page.parent / FOLDER / READINGS)))
        files.append(page)
    return Reproduction(tuple(results), tuple(files), seconds)


def builder_of(data: Path) -> list[str]:
    """What a builder would see, in a few sentences, from the readings' data; nothing where these are not there."""
    return list(json.loads(data.read_text()).get("builder", [])) if data.exists() else []


def write(result: FigureResult, folder: Path) -> list[Path]:
    """Writes NAME.png and NAME.json into a folder; returns them."""
    folder.mkdir(parents=True, exist_ok=True)
    picture = folder / f"{result.name}.png"
    figure = Figure(figsize=result.size)
    FigureCanvasAgg(figure)
    figure.set_layout_engine("constrained", w_pad=0.1, h_pad=0.06)
    result.draw(figure)
    with whole_file(picture) as partial:
        figure.savefig(partial, dpi=90)
    data = folder / f"{result.name}.json"
    verdicts = [verdict.as_dict() for verdict in result.verdicts]
    whole = {"title": result.title, "verdicts": verdicts, "data": result.data}
    replace_file(data, written_as_json(whole))
    return [picture, data]


def written_as_json(value: Any) -> str:
    """The text of a JSON file."""
    return json.dumps(rounded(value), allow_nan=False) + "\n"


def rounded(value: Any) -> Any:
    """The same with numbers of seven digits, and None for what is none, as JSON knows no nan."""
    if isinstance(value, dict):
        return {str(key): rounded(own) for key, own in value.items()}
    if isinstance(value, (list, tuple)):
        return [rounded(own) for own in value]
    if isinstance(value, float):
        return float(f"{value:.7g}") if math.isfinite(value) else None
    return value


def replace_file(path: Path, text: str) -> None:
    """Writes a file whole or not at all."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with whole_file(path) as partial:
        partial.write_text(text)
