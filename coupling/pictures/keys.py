"""The keys of a picture, below all."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.artist import Artist
from matplotlib.figure import Figure

PAD = 0.04  # inches, at least, at the left and right


def put_keys(figure: Figure, keys: Sequence[Artist]) -> None:
    """Put keys below all, each name once, on as few lines as the width takes."""
    chosen = list({key.get_label(): key for key in reversed(keys)}.values())[::-1]
    for lines in range(1, len(chosen) + 1):
        columns = -(-len(chosen) // lines)
        legend = figure.legend(handles=chosen, loc="outside lower center", ncols=columns, frameon=False, borderpad=0.1)
        if columns == 1 or legend.get_window_extent().width < figure.bbox.width - 2 * PAD * figure.dpi:
            return
        legend.remove()
