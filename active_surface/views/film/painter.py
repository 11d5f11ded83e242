"""Painter: who draws the frames of a film, pyvista or, where that cannot, matplotlib."""

from __future__ import annotations

from contextlib import AbstractContextManager, closing, nullcontext
from typing import Protocol

from active_surface.arrays import Image
from active_surface.views.film.frames import Frame
from active_surface.views.film.look import Look
from active_surface.views.film.offscreen import prepare

RENDERERS = ("auto", "pyvista", "matplotlib")


class Painter(Protocol):
    """Draws frames."""

    def paint(self, frame: Frame) -> Image:
        """The picture (height, width, 3) of a frame, without words."""


def chosen(renderer: str) -> tuple[str, str | None]:
    """The renderer that is taken where one is wished for, and why pyvista is not where it might have been.

    Raises ValueError for another name, and where pyvista is wished for and cannot draw.
    """
    if renderer not in RENDERERS:
        raise ValueError(f"Input renderer must be {', '.join(RENDERERS)}; got {renderer!r}")
    if renderer == "matplotlib":
        return renderer, None
    reason = prepare()
    if reason is None:
        return "pyvista", None
    if renderer == "pyvista":
        raise ValueError(f"Input renderer must be auto or matplotlib, as pyvista cannot draw here: {reason}")
    return "matplotlib", reason


def painter(renderer: str, look: Look) -> AbstractContextManager[Painter]:
    """The painter of a chosen renderer, to be closed after the last frame."""
    if renderer == "pyvista":
        from active_surface.views.film.vtk_painter import VtkPainter

        return closing(VtkPainter(look))
    from active_surface.views.film.agg_painter import AggPainter

    return nullcontext(AggPainter(look))
