"""The numbers of a sweep as its page has them: a map, a curve or points, and paths to look at."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib import colormaps
from matplotlib.colors import to_hex

from active_surface.arrays import FloatArray
from active_surface.studies import OUTCOMES, SENTENCES, Study
from active_surface.studies.pictures import COLOURS, Scale, Selection, edges, outline
from active_surface.views.pages.packed import packed, packed_rows
from active_surface.views.pages.sweep_paths import Paths
from common import Unit, unit_for
from coupling.case import Case, PlateCase
from coupling.report import with_micro_signs
from meshes import rim_curves

MAX_ENDS = 100_000  # of all starts; of more only the first of each point
MAX_ACTUATORS = 400  # that are drawn
RIM_STAYS = (
    "supports",
    "theory",
    "in_plane_supports",
    "youngs_modulus",
    "poisson_ratio",
    "wafer",
    "wafer_angle",
    "c11",
    "c12",
    "c44",
    "thickness",
    "density",
    "inertia",
    "damping",
    "tension",
    "pressure",
    "foundation",
    "cell_size",
    "top_face",
)
FACE_OF = ("footprint", "sides", "radius", "corners")
STOPS = 9  # of the colour scale


def study_data(study: Study, selection: Selection, starts: FloatArray, paths: Paths) -> dict[str, Any]:
    """What the programs of the page read; starts: (..., 2) m, of the first repeat of each cell."""
    ends = selection.end if selection.end[..., 0].size <= MAX_ENDS else selection.end[..., :1, :]
    places = np.concatenate([ends.reshape(-1, 2), starts.reshape(-1, 2)])
    known = places[np.isfinite(places).all(axis=1)]
    along = unit_for(known if len(known) else np.zeros((1, 2)), "m")
    lengths = selection.mean_distance
    finite = lengths[np.isfinite(lengths)]
    unit = unit_for(finite if len(finite) else np.zeros(1), "m")
    cells = {number: cell for cell, number in enumerate(selection.numbers[..., 0].ravel().tolist())}
    lines = sorted((cells[number], line) for number, line in paths.lines.items())
    headings = [heading for _, heading in sorted((cells[number], turn) for number, turn in paths.headings.items())]
    every = np.concatenate([line for _, line in lines]) if lines else np.empty((0, 2))
    return {
        "kind": "points" if selection.findings.scattered else "map" if len(selection.axes) == 2 else "curve",
        "axes": [_axis(scale, not selection.findings.scattered) for scale in selection.axes],
        "others": [_axis(scale, False) for scale in _others(study, selection)],
        "outline": outline(*selection.axes, selection.holds)
        if selection.holds is not None and len(selection.axes) == 2
        else [],
        "threshold": with_micro_signs(study.threshold.text) if study.threshold else "",
        "units": {"length": along.name, "distance": unit.name},
        "distance": packed(lengths.ravel() * unit.per_si, "f4"),
        "outcome": packed(selection.usual_outcome.ravel(), "u1"),
        "outcomes": [list(pair) for pair in zip(OUTCOMES, SENTENCES, strict=True)],
        "colours": COLOURS,
        "scale": [[k / STOPS, to_hex(colormaps["viridis"](k / STOPS))] for k in range(STOPS + 1)],
        "starts": packed(starts.reshape(-1, 2) * along.per_si, "f4"),
        "ends": packed(ends * along.per_si, "f4"),
        "repeats": selection.end.shape[-2],
        "kept": ends.shape[-2],
        "paths": {
            "cells": packed([cell for cell, _ in lines], "u4"),
            "stops": packed(np.cumsum([len(line) for _, line in lines]), "u4"),
            "points": packed_rows(every.T * along.per_si),
            **({"headings": packed(headings, "f4")} if headings else {}),
        },
        "drawing": _drawing(study, along),
    }


def _others(study: Study, selection: Selection) -> list[Scale]:
    """The axes of points that are not drawn."""
    if not selection.findings.scattered:
        return []
    axes = study.points.axes
    columns = study.points.columns(range(len(selection.distance)))
    return [Scale.of(axis, column) for axis, column in list(zip(axes, columns, strict=True))[len(selection.axes) :]]


def _axis(scale: Scale, in_cells: bool) -> dict[str, Any]:
    return {
        "name": scale.axis.name,
        "label": scale.label,
        "unit": "" if scale.unit.name == "1" else scale.unit.name,
        "values": packed(scale.drawn, "f8" if in_cells else "f4"),  # of points there are many
        "edges": packed(edges(scale) if in_cells else [], "f8"),
        "logarithmic": scale.logarithmic,
        "texts": [with_micro_signs(text) for text in scale.texts],
    }


def _drawing(study: Study, along: Unit) -> dict[str, Any]:
    """Rim, actuators and the part's face, except for those that the axes move."""
    case: Case = study.case
    moved = [location for axis in study.points.axes for location in axis.field.locations]
    rim: list[Any] = []
    if isinstance(case.plate, PlateCase) and not any(
        location[0] == "plate" and location[1] not in RIM_STAYS for location in moved
    ):
        outline = case.plate.coarse_mesh.outline
        rim = [packed(curve * along.per_si, "f4") for curve in rim_curves(outline)]
    stay = not any(
        location[0] == "lattice" or "position" in location[1:] for location in moved if location[0] != "part"
    )
    places = [actuator.position for actuator in case.actuators]
    drawn = places if stay and len(places) <= MAX_ACTUATORS else []
    face = case.part.face
    if any(location[0] == "part" and location[1] in FACE_OF for location in moved):
        face = None
    return {
        "rim": rim,
        "actuators": packed(np.array(drawn).reshape(-1, 2) * along.per_si, "f4"),
        **({} if face is None else {"face": (face.outline((0.0, 0.0), 0.0) * along.per_si).tolist()}),
    }
