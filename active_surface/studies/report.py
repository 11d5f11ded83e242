"""A sweep in words and in numbers: what the command prints."""

from __future__ import annotations

from typing import Any

import numpy as np

from active_surface.studies.axis import counted
from active_surface.studies.run import Sweep

MICRO = 1e6


def figures(sweep: Sweep) -> dict[str, Any]:
    """The figures of a sweep by name."""
    return {
        "paths": len(sweep.study.points),
        "kept": sweep.kept,
        "dimensions": sweep.study.points.dimensions,
        "outcomes": sweep.outcomes,
        "first_refused": sweep.first_refused,
        "warnings": sweep.warnings,
        "largest_distance": _largest(sweep),
        "files": [str(file) for file in sweep.files],
    }


def lines(sweep: Sweep) -> list[tuple[str, str]]:
    """Rows (label, text) to print."""
    sizes = sweep.study.points.dimensions
    plural = {"point": "points", "repeat": "repeats"}
    shape = " x ".join(f"{count} {plural.get(name, name)}" for name, count in sizes.items())
    rows = [
        ("paths", f"{len(sweep.study.points)}: {shape}"),
        *([("kept", _kept(sweep))] if sweep.kept else []),
        ("outcomes", ", ".join(f"{count} {name}" for name, count in sweep.outcomes.items())),
    ]
    if (largest := _largest(sweep)) is not None:
        rows.append(("distance", f"{largest * MICRO:.4f} um at most"))
    if wrong := sweep.first_refused:
        rows.append(("refused", f"{_refused(sweep)}: {'; '.join(wrong)}"))
    return rows + [("wrote", str(file)) for file in sweep.files]


def _refused(sweep: Sweep) -> str:
    """How many paths were refused, and which is the first."""
    points, refused = sweep.study.points, sweep.refused
    (values,) = points.values(refused[:1])
    texts = [
        f"{value:.6g}" if axis.kind is np.float64 else str(value)
        for axis, value in zip(points.axes, values, strict=True)
    ]
    at = [f"{axis.name} = {counted(text, axis.field.unit)}" for axis, text in zip(points.axes, texts, strict=True)]
    first = "at" if len(refused) == 1 else "the first at"
    return f"{len(refused)} of {len(points)} paths, {first} {', '.join(at)}"


def _kept(sweep: Sweep) -> str:
    """How many paths an earlier sweep left, and how many are new."""
    new = len(sweep.study.points) - sweep.kept
    return f"{sweep.kept} of these paths from an earlier sweep; {new or 'none'} {'is' if new == 1 else 'are'} new"


def _largest(sweep: Sweep) -> float | None:
    """The largest distance [m] that a part went; None: there was no path."""
    distances = sweep.dataset["distance"].values
    return None if np.isnan(distances).all() else float(np.nanmax(distances))
