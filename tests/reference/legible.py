"""What makes a drawn figure legible: nothing blank, clipped or overlapping, and labels with units."""

import re
import warnings
from itertools import pairwise

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.text import Text

from active_surface.views.prints.sheet import MM


def seen(figure):
    """The texts of a drawn figure with their boxes in pixels."""
    canvas = FigureCanvasAgg(figure)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        canvas.draw()
    found = []
    for text in figure.findobj(lambda artist: isinstance(artist, Text) and artist.get_visible()):
        # Ticks beyond the limits of an axis have texts that are not drawn.
        if text.get_text().strip() and inside_its_axis(figure, text):
            found.append((text.get_text(), text.get_window_extent(canvas.get_renderer())))
    return found


def inside_its_axis(figure, text):
    for axes in figure.axes:
        for axis in (axes.xaxis, axes.yaxis):
            for tick in axis.get_major_ticks() + axis.get_minor_ticks():
                if text in (tick.label1, tick.label2):
                    low, high = sorted(axis.get_view_interval())
                    return low <= tick.get_loc() <= high and tick.label1.get_visible()
    return True


def check(figure, width):
    """Nothing is blank or clipped, letters are not too small, and places, times and bars have units."""
    assert figure.get_figwidth() == pytest.approx(width * MM)
    texts = seen(figure)
    for said, box in texts:
        assert box.x0 >= 0 and box.y0 >= 0, said
        assert box.x1 <= figure.bbox.x1 and box.y1 <= figure.bbox.y1, said
    for axes in figure.axes:
        for label in (axes.get_xlabel(), axes.get_ylabel()):
            assert not label or re.search(r"\[(.+)\]$", label), label
    labels = [axes.yaxis.label.get_window_extent() for axes in figure.axes if axes.get_ylabel()]
    for one, other in pairwise(sorted(labels, key=lambda box: (round(box.x0, -1), box.y0))):
        assert one.x1 <= other.x0 or one.y1 <= other.y0 + 1 or other.y1 <= one.y0 + 1
    pixels = np.asarray(figure.canvas.buffer_rgba())[..., :3]
    assert 0.01 < (pixels.min(axis=-1) < 250).mean() < 0.95
    for edge in (pixels[0], pixels[-1], pixels[:, 0], pixels[:, -1]):
        assert (edge > 200).all()
