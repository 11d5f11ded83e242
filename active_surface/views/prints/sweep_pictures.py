"""Pictures of a sweep for print."""

from __future__ import annotations

from matplotlib.figure import Figure

from active_surface.studies.pictures import Findings, Panel, Selection, about, outcome_panel, panels, value_panel
from active_surface.views.prints.sheet import Picture

OUTCOME = "outcome"
HEIGHT = 0.85  # of the width, where a picture has no shape of its own


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
