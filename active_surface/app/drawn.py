"""Drawn: paths and plates in the numbers of the page, in the unit of its map."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from active_surface.arrays import FloatArray
from active_surface.studies.drifts import Drift, Fate
from active_surface.views import packed, thinned
from common import Unit, quantity_text, unit_for
from coupling import report
from coupling.case import Case, PlateCase
from fem_plate import extent
from meshes import rim_curves
from particle import Trajectory

PIECES: Final = 3  # of a path between two rows
SEEN: Final = 5e-4  # of the extent of a path: less is not seen
MICROMETRES, LARGE = Unit("\N{MICRO SIGN}m", 1e6), 1e-2  # m
MAX_DRAGGED: Final = 300  # actuators; more are dots


def map_of(case: Case) -> dict[str, Any]:
    """The plate from above with what lies on it."""
    box, unit = _box(case), unit_of(case)
    curves: list[FloatArray] = []
    if isinstance(case.plate, PlateCase):
        outline = case.plate.coarse_mesh.outline
        curves = rim_curves(outline, extent(outline.box) / 150)
    places = np.array([one.position for one in case.actuators]).reshape(-1, 2)
    return {
        "unit": unit.name,
        "perSI": unit.per_si,
        "box": (box * unit.per_si).tolist(),
        "rim": [packed(curve * unit.per_si, "f4") for curve in curves],
        "actuators": (places * unit.per_si).tolist(),
        "endless": not isinstance(case.plate, PlateCase),  # so that the path gives the frame
        "dragged": len(places) <= MAX_DRAGGED,
        "start": (np.array(case.part.position) * unit.per_si).tolist(),
        "face": face_of(case),
        "heading": case.part.heading,
    }


def face_of(case: Case) -> list[list[float]] | None:
    """The corners of the part's face before it is turned; None: it is a point."""
    face = case.part.face
    return None if face is None else (face.outline((0.0, 0.0), 0.0) * unit_of(case).per_si).tolist()


def path_of(path: Trajectory, unit: Unit, error: float | None = None) -> dict[str, Any]:
    """A path, how it ended and how far the part came; error: of its end [m], where it is estimated."""
    line = _curve(path)
    line = thinned(line, SEEN * extent(line))
    return {
        "line": packed(line * unit.per_si, "f4"),
        "outcome": path.outcome.value,
        "sentence": report.with_micro_signs(path.sentence),
        "distance": quantity_text(path.distance, "m", 4),
        "error": None if error is None else quantity_text(error, "m", 2),
        "duration": quantity_text(float(path.time[-1]), "s", 3),
        "end": (path.position[-1] * unit.per_si).tolist(),
        "heading": None if path.heading is None else float(path.heading[-1]),
    }


def drift_of(found: Drift, unit: Unit) -> dict[str, Any]:
    """Where parts go: arrows, places where they stay and where they are lost, and what becomes of them in words."""
    one = found.maps[0]
    moves, stays = one.fates == Fate.MOVES, one.fates == Fate.STAYS
    places, ways = one.starts * unit.per_si, one.arrows(one.speed) * unit.per_si
    period = quantity_text(one.period, "s")
    return {
        "arrows": packed(np.column_stack([places[moves] - ways / 2, places[moves] + ways / 2]), "f4"),
        "still": packed(places[stays], "f4"),
        "lost": packed(places[~moves & ~stays], "f4"),
        "text": report.with_micro_signs(
            f"Where parts go in a period, {period}{one.later}: {one.text}. Dots: it stays; +: it comes off or leaves."
        ),
        "warnings": found.warnings(),
    }


def unit_of(case: Case) -> Unit:
    """The unit of the map: micrometres, in which case files have places, up to LARGE."""
    box = _box(case)
    return MICROMETRES if float(np.abs(box).max()) < LARGE else unit_for(box, "m")


def _box(case: Case) -> FloatArray:
    """The corners (2, 2) [m] of the plate, or of the surroundings of a part on a platform."""
    if isinstance(case.plate, PlateCase):
        return np.asarray(case.plate.coarse_mesh.outline.box)
    start = np.array(case.part.position)
    reach = max(float(np.abs(start).max()), 1e-4)
    return np.stack([start - reach, start + reach])


def _curve(path: Trajectory) -> FloatArray:
    """Points (n, 2) [m] along a path: cubics between the integrator's rows, with its velocities at these."""
    share = np.arange(PIECES)[:, None, None] / PIECES
    span, p, v = np.diff(path.time)[:, None], path.position, path.velocity
    begin = (1 + 2 * share) * (1 - share) ** 2 * p[:-1] + share * (1 - share) ** 2 * span * v[:-1]
    end = share**2 * (3 - 2 * share) * p[1:] - share**2 * (1 - share) * span * v[1:]
    return np.concatenate([(begin + end).transpose(1, 0, 2).reshape(-1, 2), p[-1:]])
