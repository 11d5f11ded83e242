"""Plot: the pictures of a result, whatever it is of, into files for print."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from matplotlib.figure import Figure

from active_surface.studies import ENDING, key_of
from active_surface.studies.pictures import (
    Findings,
    Panel,
    Selection,
    about,
    outcome_panel,
    panels,
    read_findings,
    value_panel,
)
from active_surface.views.prints.run_pictures import run_pictures
from active_surface.views.prints.sheet import FORMATS, WIDTH, Picture, drawn, save
from coupling.pictures import portrait_of
from coupling.results import instead, is_run, read_run

OUTCOME = "outcome"
HEIGHT = 0.85  # of the width, where a picture has no shape of its own


class Plotted(NamedTuple):
    """A picture in its files."""

    caption: str
    files: tuple[Path, ...]
    complete: bool = True  # whether the result is that of a whole run


def plot(
    path: str | Path,
    output: str | Path | None = None,
    formats: Sequence[str] = FORMATS[:1],
    width: float = WIDTH,
    x: str | None = None,
    y: str | None = None,
    value: str | None = None,
) -> list[Plotted]:
    """Draw a run or a sweep into a folder as NAME.path.pdf, NAME.time.pdf and so on.

    Parameters
    ----------
    path : path
        A file of a run or sweep, or FOLDER/NAME of a run.
    output : path, optional
        The folder; by default that of the result.
    formats : sequence of str
        Of `"pdf"`, `"svg"`, `"png"`.
    width : float
        Width of the pictures, mm.
    x, y : str, optional
        Names of the axes of a sweep to draw over.
    value : str, optional
        The only column of a sweep's results to draw.

    Returns
    -------
    pictures : dict
        Captions, by file.

    Raises
    ------
    ValueError
        The path leads to anything else, or a format, width or name is refused.
    OSError
        A picture cannot be written.
    """
    unknown = [kind for kind in formats if kind not in FORMATS]
    if unknown:
        raise ValueError(f"Input formats must be of {', '.join(FORMATS)}; got {', '.join(unknown)}")
    name, pictures, complete = _pictures(Path(path), x, y, value)
    figures = [drawn(picture, width) for picture in pictures]  # all of them, before a file is written
    folder = Path(path).parent if output is None else Path(output)
    folder.mkdir(parents=True, exist_ok=True)
    return [
        Plotted(picture.caption, tuple(save(figure, folder / f"{name}.{picture.name}", formats)), complete)
        for picture, figure in zip(pictures, figures, strict=True)
    ]


def _pictures(path: Path, x: str | None, y: str | None, value: str | None) -> tuple[str, list[Picture], bool]:
    """The name of a result, its pictures, and whether it was written to the end."""
    if is_run(path):
        names = [key for key, name in (("x", x), ("y", y), ("value", value)) if name is not None]
        if names:
            raise ValueError(f"Input {' and '.join(names)} of plot must be given for a sweep only; {path} is of a run")
        run = read_run(path)
        return run.name, run_pictures(portrait_of(run)), run.complete
    file = path if path.is_file() else path.with_name(path.name + ENDING)
    if key_of(file) is None:
        required = "must be a file that `active-surface run` or `active-surface sweep` left"
        other = "which is another file" if path.is_file() and path.suffix == ENDING else instead(path)
        raise ValueError(f"Input result of plot {required}; got {path}, {other}")
    with read_findings(file) as findings:
        return findings.name, sweep_pictures(findings, x, y, value), True


def sweep_pictures(
    findings: Findings, x: str | None = None, y: str | None = None, value: str | None = None
) -> list[Picture]:
    """The pictures that tell of a sweep, over the axes named x and y; or that of one column of its results.

    They hold all that they show, so that the file may be closed.
    Raises ValueError for a name that there is not.
    """
    selection = Selection.of(findings, x, y, value)
    one = outcome_panel if value == OUTCOME else value_panel
    chosen = panels(selection) if value is None else [one(selection)]
    return [_picture(panel, selection) for panel in chosen]


def _picture(panel: Panel, selection: Selection) -> Picture:
    def draw(figure: Figure) -> None:
        axes = figure.add_subplot()
        panel.draw(figure, axes)
        if axes.get_aspect() == "auto":
            figure.set_figheight(HEIGHT * figure.get_figwidth())

    caption = panel.title[0].upper() + panel.title[1:]
    return Picture(panel.name, f"{caption}: {about(selection)}.", draw)
