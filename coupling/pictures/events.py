"""The events of a run as marks in a strip over time."""

from __future__ import annotations

from typing import Any, Final, NamedTuple

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from coupling.pictures.portrait import Portrait
from particle import EventKind, shade


class Mark(NamedTuple):
    """How an event is drawn and named."""

    marker: str
    colour: str
    text: str
    afterwards: str = ""  # of a part that it lost


MARKS: Final[dict[EventKind, Mark]] = {
    EventKind.SLIPS: Mark(">", "black", "slips"),
    EventKind.STOPS: Mark("s", "black", "stops"),
    EventKind.REVERSES: Mark("D", "white", "turns back"),
    EventKind.DETACHES: Mark("*", "white", "comes off", "came off"),
    EventKind.LANDS: Mark("v", "white", "lands"),
    EventKind.LEAVES_PLATE: Mark("X", "white", "leaves the plate", "left the plate"),
    EventKind.OVERLOADS: Mark("P", "white", "overload", "overloaded"),
}
APART = 3.5  # points: nearer to each other, marks of events merge
OFTEN = (EventKind.SLIPS, EventKind.STOPS)  # where shades begin and end in any case


def draw_events(
    axes: Axes, portrait: Portrait, per_second: float, width: float, span: tuple[float, float] | None = None
) -> list[Artist]:
    """Draw a strip of states with a mark for each event, or for rare ones where all would merge; return keys.

    width: of the axes [points].  span: of time that is shown [s]; None: all.
    """
    shade(axes, portrait.rows, per_second)
    axes.set_yticks([])
    axes.set_ylim(0, 1)
    axes.tick_params(bottom=False, labelbottom=False)
    begin, end = span or (0.0, float(portrait.rows.time[-1]))
    events = [event for event in portrait.events if begin <= event.time <= end]
    keys: list[Artist] = []
    for kind, (marker, colour, text, _) in MARKS.items():
        times = [event.time for event in events if event.kind is kind]
        if not times or (kind in OFTEN and len(events) > width / APART):
            continue
        look: dict[str, Any] = {"marker": marker, "color": colour, "markeredgecolor": "black", "linestyle": ""}
        look |= {"markersize": APART, "markeredgewidth": 0.6}
        axes.plot(np.array(times) * per_second, np.full(len(times), 0.5), **look, clip_on=False)
        keys.append(Line2D([], [], **look, label=text))
    return keys
