"""The picture of a sweep: curves over one axis, maps over two, places of random points, basins over starts."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from matplotlib.figure import Figure

from active_surface.studies.pictures.findings import Findings
from active_surface.studies.pictures.panel import panels
from active_surface.studies.pictures.selection import Selection
from active_surface.studies.study import Study
from coupling.pictures import save_picture
from meshes import Drawing

if TYPE_CHECKING:
    import xarray

WIDTH, HEIGHT = 6.2, 5.2  # inches, of a panel


def draw_sweep(study: Study, dataset: xarray.Dataset, path: Path) -> Path:
    """Draw the results of a study into a PNG file; return its path.

    Of a grid the two axes with the most values are drawn, the others at their middle value; of repeats the mean.
    """
    figure = Drawing()
    compose(figure, Findings.of(study.name, dataset, study.threshold))
    return save_picture(figure, path)


def compose(figure: Figure, findings: Findings) -> None:
    """Draw the results of a sweep into an empty figure."""
    selection = Selection.of(findings)
    drawn = panels(selection)
    figure.set_size_inches(WIDTH * len(drawn), HEIGHT)
    figure.set_layout_engine("constrained", w_pad=0.1, h_pad=0.06)
    places = [figure.add_subplot(1, len(drawn), k + 1) for k in range(len(drawn))]
    for axes, panel in zip(places, drawn, strict=True):
        panel.draw(figure, axes)
        axes.set_title(panel.title, fontsize=10, parse_math=False)
    figure.suptitle(f"{findings.name}: {about(selection)}", parse_math=False)


def about(selection: Selection) -> str:
    """What is shown, in words."""
    of, drawn, repeats = selection.findings.dataset["outcome"].size, selection.outcome.size, selection.findings.repeats
    parts = [f"{of} paths" if drawn == of else f"{drawn} of {of} paths"]
    if repeats > 1:
        parts.append(f"mean of {repeats} starts")
    return ", ".join(parts + [f"{name} = {text}" for name, text in selection.fixed.items()])
