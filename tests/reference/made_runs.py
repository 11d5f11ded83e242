"""Runs as if read from files, made up: a square plate with one actuator, a part that is where it is told to be."""

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from coupling.case import Case
from coupling.margins import MarginCurves
from coupling.results.saved import SavedRun
from particle import Samples

SIDE = 1e-3  # m
PARTS = 20
CASE = {
    "plate": {"shape": "rectangle", "width": SIDE, "height": SIDE, "youngs_modulus": 169e9, "poisson_ratio": 0.3}
    | {"thickness": 1e-5},
    "actuators": [{"position": (0.0, 0.0), "stroke": 1e-5, "frequency": 500.0}],
    "part": {"mass": 2e-9, "position": (0.0, 0.0)},
    "friction": {"model": "constant", "limit": 1e-9},
    "run": {"duration": 4e-3},
    "name": "made",
}


@dataclass(frozen=True, eq=False)
class MadeRun(SavedRun):
    """A saved run without files."""

    heights: np.ndarray = None
    part: dict = field(default_factory=dict)

    @property
    def case(self):
        return Case.model_validate(CASE | {"part": CASE["part"] | self.part})

    def plate_field(self, name, steps=slice(None)):
        assert name == "deflection"
        return self.heights[steps]


def grid(holes=()):
    """Points (n, 2), the middle first, and triangles (m, 3) of a square; holes: numbers of squares that it lacks."""
    side = SIDE * (np.arange(PARTS + 1) / PARTS - 0.5)
    points = np.stack(np.meshgrid(side, side, indexing="ij"), axis=-1).reshape(-1, 2)
    corner = np.array([(PARTS + 1) * i + j for i in range(PARTS) for j in range(PARTS) if (i, j) not in holes])
    right = corner + PARTS + 1
    triangles = np.concatenate(
        [np.stack([corner, right, right + 1], axis=1), np.stack([corner, right + 1, corner + 1], axis=1)]
    )
    middle = len(points) // 2
    swap = np.arange(len(points))
    swap[[0, middle]] = middle, 0
    return points[swap], swap[triangles]


def hill(points, height, middle=(0.0, 0.0), width=2e-4):
    """A hill (n,) [m] around a middle."""
    return height * np.exp(-np.square((points - np.array(middle)) / width).sum(axis=1))


def made_run(path, heights, time=None, state=1, above=0.0, holes=(), actuators=1):
    """A run whose part is at places (k, 2) [m], so much above z = 0, over heights (k, n) or of a function of points."""
    points, triangles = grid(holes)
    path = np.asarray(path, dtype=float)
    k = len(path)
    if callable(heights):
        heights = np.stack([heights(points)] * k)
    position = np.column_stack([path, np.broadcast_to(above, k)])
    time = 1e-3 * np.arange(k) if time is None else np.asarray(time, dtype=float)
    state = np.broadcast_to(state, k).astype(int)
    empty = dict.fromkeys(Samples._fields, np.empty(0)) | dict.fromkeys(Samples._field_defaults)
    rows = Samples(**empty | {"time": time, "position": path, "state": state})
    return MadeRun(
        heading=None,
        pressure_margin=None,
        air_force=None,
        name="made",
        complete=True,
        summary={},
        versions={},
        units={},
        time=time,
        points=points,
        triangles=triangles,
        actuators=points[:actuators],
        position=position,
        velocity=np.zeros((k, 3)),
        state=state,
        normal_force=np.zeros(k),
        friction_force=np.zeros(k),
        events=[],
        rows=rows,
        margins=MarginCurves(time, *np.full((2, k), np.nan)),
        event_actuators=np.empty(0, int),
        plate_fields=("deflection",),
        plate_path=Path("made.plate.vtkhdf"),
        part_path=Path("made.part.vtkhdf"),
        heights=np.asarray(heights, dtype=np.float32),
    )
