"""The numbers of a run as its page has them: a surface of modes, and the part on it, in units that are easy to read."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import cycle
from typing import Any, Final

import numpy as np
from matplotlib.colors import Normalize, to_hex

from active_surface.arrays import BoolArray, FloatArray, IntArray
from active_surface.views.geometry import Spots, coarse, cut_in, exaggeration, inside, outer_edges, spots_of
from active_surface.views.modes import modes_of
from active_surface.views.pages.moments import MAX_EVENTS, Moments, beside, heights_at, moments_of
from active_surface.views.pages.packed import packed, packed_rows
from active_surface.views.pages.run_curves import counted, curves_of
from active_surface.views.result_file import part_of
from common import Unit, unit_for
from coupling import report
from coupling.pictures import MARKS, PARTS_COLOURS, Scale, path_window
from coupling.results import SavedRun
from fem_plate import extent
from particle import EventKind, State, stretches

MAX_POINTS: Final = 6000  # of its surface; of more, those around the path, or fewer of these
MAX_ACTUATORS: Final = 1000  # that are marked
MAX_NUMBERED: Final = 30  # of them, with their numbers
MARGIN: Final = 0.1  # of the path's extent, of thinned surfaces around it
EVENT_DIGITS: Final = 6  # of the time of an event
LINES, PER_LINE = 16, 64  # drawn on the surface along each side, and points on each
STRETCHES: Final = {"stuck": State.STICK, "flying": State.FLIGHT}
COUNTS: Final = {EventKind.SLIPS: report.PULLS, EventKind.DETACHES: report.LIFTS}
COLOURS: Final = 11  # stops of the colour scale


def run_data(run: SavedRun, others: Sequence[SavedRun] = ()) -> dict[str, Any]:
    """What the programs of the page read; others: over the same surface, whose parts are shown as well."""
    moments = moments_of(run)
    also = [(one, beside(one, moments)) for one in others]
    ways = [one.rows.position for one in others]
    ways += [_outlines(one, there).reshape(-1, 2) for one, there in [(run, moments), *also]]
    way = np.concatenate([moments.position[:, :2], *ways])
    points, triangles = _around(run.points, run.triangles, way)
    heights = heights_at(run, moments, points)
    place = run.points[points]
    length = float(np.ptp(place, axis=0).max())
    along, clock = unit_for(place, "m"), unit_for(run.time, "s")
    position = moments.position
    spots = spots_of(place, triangles, position[:, :2])
    drawn = np.where(moments.state == State.FLIGHT, position[:, 2], spots.heights(heights))
    scale = Scale.of(np.array([heights.min(), heights.max()]))
    highest = max(float(drawn.max()), float(heights.max()))
    lowest = min(float(drawn.min()), float(heights.min()))
    box = np.stack([place.min(axis=0), place.max(axis=0)])
    window = path_window(np.concatenate([run.rows.position, *ways]), box, run.actuators)
    modes = modes_of(heights, None if window is None else _close(place, triangles, window))
    marked = np.flatnonzero(points < len(run.actuators))
    in_box = int(((run.actuators >= box[0]) & (run.actuators <= box[1])).all(axis=1).sum())
    speed, events = unit_for(moments.velocity, "m/s"), int(moments.at_event.sum())
    return {
        "time": packed(moments.time * clock.per_si, "f8"),
        "units": {"time": clock.name, "length": along.name, "height": scale.unit.name, "speed": speed.name},
        "steps": {"shown": len(moments.time) - events, "stored": len(run.time), "events": events},
        "counted": counted(run),
        "exaggeration": [exaggeration(highest - lowest, length), _closer(position[:, 2], window)],
        "window": None if window is None else (window * along.per_si).tolist(),
        "perLength": scale.unit.per_si / along.per_si,
        "surface": {
            "x": packed(place[:, 0] * along.per_si, "f4"),
            "y": packed(place[:, 1] * along.per_si, "f4"),
            "triangles": packed(triangles, "u2"),
            "shapes": packed_rows(modes.shapes, exact=window is not None),
            "amplitudes": packed(modes.amplitudes * scale.unit.per_si, "f4"),
            "range": (spread := [float(w) * scale.unit.per_si for w in (heights.min(), heights.max())]),
            "colours": _colours(scale, *spread),
            "extent": [lowest * scale.unit.per_si, highest * scale.unit.per_si],
            "error": modes.error * scale.unit.per_si,
            "rim": packed(outer_edges(triangles), "u2"),
            "lines": [_lines(place, triangles, box) for box in ([box] if window is None else [box, window])],
            "actuators": packed(marked if in_box <= MAX_ACTUATORS else [], "u2"),
            "numbers": points[marked].tolist() if in_box <= MAX_NUMBERED else [],
            "unmarked": in_box if in_box > MAX_ACTUATORS else 0,
            "whole": len(np.unique(run.triangles)) == len(points),
        },
        "part": {
            "x": packed(position[:, 0] * along.per_si, "f4"),
            "y": packed(position[:, 1] * along.per_si, "f4"),
            "z": packed(drawn * scale.unit.per_si, "f4"),
            "height": packed(position[:, 2] * scale.unit.per_si, "f4"),
            "speed": packed(np.hypot(*moments.velocity.T) * speed.per_si, "f4"),
            "state": packed(moments.state, "u1"),
            "below": _spots(spots),
            **_face(run, moments, place, triangles, heights, along, scale.unit),
        },
        "name": part_of(run) if others else "part",
        "others": [
            _beside(one, there, colour, heights, place, triangles, along, scale.unit)
            for (one, there), colour in zip(also, cycle(PARTS_COLOURS[1:]), strict=False)
        ],
        "trail": _trail(place, triangles, position[:, :2], length),
        "stretches": {name: packed(_stretches(run, state) * clock.per_si, "f4") for name, state in STRETCHES.items()},
        "curves": curves_of(run, along),
        "perSecond": clock.per_si,
        "load": _force(moments.normal_force),
        "friction": _force(moments.friction_force),
        "events": _events(run, clock),
        "moreEvents": max(len(run.events) - MAX_EVENTS, 0),
        "lost": MARKS[run.loss.kind][3] if run.loss and run.complete else "",
    }


def _beside(
    run: SavedRun,
    moments: Moments,
    colour: str,
    heights: FloatArray,
    place: FloatArray,
    triangles: IntArray,
    along: Unit,
    up: Unit,
) -> dict[str, Any]:
    """Another part at the moments (k,) of the page, at which points (n, 2) [m] have heights (k, n) [m]."""
    x, y, z = moments.position.T
    spots = spots_of(place, triangles, moments.position[:, :2])
    drawn = np.where(moments.state == State.FLIGHT, z, spots.heights(heights))
    places = {"x": x * along.per_si, "y": y * along.per_si, "z": drawn * up.per_si}
    packed_places = {key: packed(values, "f4") for key, values in places.items()}
    face = _face(run, moments, place, triangles, heights, along, up)
    return {"name": part_of(run), "colour": colour, **packed_places, "below": _spots(spots), **face}


def _colours(scale: Scale, low: float, high: float) -> list[list[Any]]:
    """The colours from the lowest to the highest height, as stops from 0 to 1."""
    stops = np.linspace(0, 1, COLOURS)
    norm = scale.norm if scale.highest > scale.lowest else Normalize(0, 1)
    return [[stop, to_hex(scale.colours(norm(low + stop * (high - low))))] for stop in stops.tolist()]


def _close(points: FloatArray, triangles: IntArray, window: FloatArray) -> BoolArray:
    """Which points (n, 2) [m] have a triangle that reaches into a window (2, 2) [m]."""
    corners = points[triangles]
    reach = ((corners.max(axis=1) >= window[0]) & (corners.min(axis=1) <= window[1])).all(axis=1)
    return np.isin(np.arange(len(points)), triangles[reach])


def _closer(heights: FloatArray, window: FloatArray | None) -> float:
    """How many times heights [m] along a path are drawn larger in a window (2, 2) [m]."""
    return 1.0 if window is None else exaggeration(float(np.ptp(heights)), extent(window))


def _around(points: FloatArray, triangles: IntArray, path: FloatArray) -> tuple[IntArray, IntArray]:
    """The points that are drawn, by their numbers, and the triangles of these: all, or those around a path (k, 2) [m].

    All of the path is on them: where that takes too many, they are thinned.
    """
    used = np.unique(triangles)
    if len(used) > MAX_POINTS:
        corners = points[triangles]
        apart = np.maximum(corners.min(axis=1) - path.max(axis=0), path.min(axis=0) - corners.max(axis=1))
        away = apart.max(axis=1).clip(0.0)  # of each triangle from the box of the path
        first = np.full(len(points), np.inf)
        np.minimum.at(first, triangles.ravel(), np.repeat(away, 3))
        limit = np.partition(first[used], MAX_POINTS)[MAX_POINTS]
        if limit > 0:
            triangles = triangles[away < limit]
        else:
            triangles = coarse(points, triangles[away <= MARGIN * extent(path)], MAX_POINTS)
        used = np.unique(triangles)
    return used, np.searchsorted(used, triangles)


def _outlines(run: SavedRun, moments: Moments) -> FloatArray:
    """The outlines (k, c, 2) [m] of a part's face at the moments; of a point they have no corners."""
    face = run.case.part.face
    if face is None or moments.heading is None:
        return np.empty((len(moments.time), 0, 2))
    return face.outline(moments.position[:, :2], moments.heading)


def _planes(
    points: FloatArray, triangles: IntArray, heights: FloatArray, position: FloatArray, outlines: FloatArray
) -> FloatArray:
    """Planes (k, 3) through the surface under outlines (k, c, 2) [m]: their heights [m] at positions, and slopes."""
    spots = spots_of(points, triangles, outlines.reshape(-1, 2))
    moment = np.repeat(np.arange(len(outlines)), outlines.shape[1])[:, None]
    z = (heights[moment, spots.corners] * spots.weights).sum(axis=1).reshape(outlines.shape[:2])
    around = np.insert(outlines - position[:, None, :2], 0, 1.0, axis=2)
    return np.asarray((np.linalg.pinv(around) @ z[..., None])[..., 0])


def _face(
    run: SavedRun,
    moments: Moments,
    points: FloatArray,
    triangles: IntArray,
    heights: FloatArray,
    along: Unit,
    up: Unit,
) -> dict[str, Any]:
    """A part's face, how far it is turned [rad] and on which planes it lies; of a point nothing."""
    face = run.case.part.face
    if face is None or moments.heading is None:
        return {}
    planes = _planes(points, triangles, heights, moments.position, _outlines(run, moments))
    return {
        "face": (face.outline((0.0, 0.0), 0.0) * along.per_si).tolist(),
        "heading": packed(moments.heading, "f8"),
        "plane": packed(planes * up.per_si / [1.0, along.per_si, along.per_si], "f4"),
    }


def _lines(points: FloatArray, triangles: IntArray, box: FloatArray) -> dict[str, Any]:
    """Lines along x and y on the surface in a box (2, 2) [m], which show its form without colours."""
    low, high = box
    apart = float((high - low).max()) / LINES
    lines: list[FloatArray] = []
    for axis in (0, 1):
        count = max(int(np.ceil((high - low)[axis] / apart)), 1)
        for c in low[axis] + (np.arange(count) + 0.5) * (high - low)[axis] / count:
            line = np.empty((PER_LINE, 2))
            line[:, axis], line[:, 1 - axis] = c, np.linspace(low[1 - axis], high[1 - axis], PER_LINE)
            lines.append(line)
    places = np.concatenate(lines)
    on = inside(points, triangles, places)
    last = on & ~np.roll(on, -1)  # of a piece that lies on the surface
    last[PER_LINE - 1 :: PER_LINE] = on[PER_LINE - 1 :: PER_LINE]
    return _spots(spots_of(points, triangles, places[on])) | {"ends": packed(on.cumsum()[last], "u4")}


def _trail(points: FloatArray, triangles: IntArray, path: FloatArray, length: float) -> dict[str, Any]:
    """Points along the path, so close that its line lies on the surface, each with the step at which it is passed."""
    cell = length / np.sqrt(len(triangles)) if len(triangles) > 2 else length
    steps = np.hypot(*np.diff(path, axis=0).T)
    counts = np.where(steps > 0, np.ceil(2 * steps / cell), 0).astype(np.int64)
    number, share = cut_in(counts)
    places = path[number] * (1 - share)[:, None] + path[number + 1] * share[:, None]
    spots = spots_of(points, triangles, places.reshape(-1, 2))
    return _spots(spots) | {"step": packed(number, "u2")}


def _spots(spots: Spots) -> dict[str, Any]:
    return {"corners": packed(spots.corners, "u2"), "weights": packed(spots.weights[:, 1:], "f4")}


def _stretches(run: SavedRun, state: State) -> FloatArray:
    """When each stretch of a state begins and ends (s, 2) [s], as the integrator found it."""
    rows = stretches(run.rows.state == state)
    times = run.rows.time[np.array(rows, dtype=np.int64).reshape(-1, 2)]
    return np.asarray(times[times[:, 0] < run.time[-1]].clip(max=run.time[-1]))


def _force(values: FloatArray) -> dict[str, Any]:
    """A force [N] at the steps."""
    unit = unit_for(values, "N")
    return {"unit": unit.name, "values": packed(values * unit.per_si, "f4")}


def _events(run: SavedRun, clock: Unit) -> list[dict[str, Any]]:
    """The events, with what is said of each."""
    along = unit_for(run.points, "m")
    result = []
    for event, actuator in zip(run.events[:MAX_EVENTS], run.event_actuators.tolist(), strict=False):
        x, y = (c * along.per_si for c in event.position)
        when = f"{event.time * clock.per_si:.{EVENT_DIGITS}g}"
        by = "" if actuator < 0 else f"actuator {actuator} {COUNTS[event.kind]}"
        result.append(
            {
                "time": event.time * clock.per_si,
                "when": when,
                "text": f"{MARKS[event.kind][2]} at {when} {clock.name}",
                "place": f"({x:.4g}, {y:.4g}) {along.name}".replace("-", "\N{MINUS SIGN}"),
                "by": by,
            }
        )
    return result
