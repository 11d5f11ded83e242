"""Places: the squares of a plate in which a part lies at rest, and what it must bear there."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Final, NamedTuple

import numpy as np

from active_surface.arrays import BoolArray, FloatArray, IntArray
from active_surface.studies.feasibility.counting import Fields, Resting, find_responses
from meshes import Outline
from particle import Body, Micropart, PartAtRest
from particle.body import Face
from particle.friction import Contact

MAX_KEPT: Final = 30_000_000  # numbers of the surface that are kept from the search for losses to that for slips
BLOCK: Final = 3_000_000  # numbers of a face that are found at a time


class Squares(NamedTuple):
    """What an outline encloses, cut into squares side by side."""

    centres: FloatArray  # (n, 2) m
    side: float  # m
    neighbours: IntArray  # (n, 4) those at -x, +x, -y and +y; where there is none the square itself


def squares_within(outline: Outline, across: int, rest: PartAtRest | None = None) -> Squares:
    """Squares whose centres an outline encloses, so many along its longer side; for a face where all of it lies within.

    Raises ValueError where it does nowhere.
    """
    low, high = outline.box
    side = float((high - low).max()) / across
    counts = np.ceil((high - low) / side - 1e-9).astype(int)
    along = [middle + side * (np.arange(n) - (n - 1) / 2) for middle, n in zip((low + high) / 2, counts, strict=True)]
    grid = np.stack(np.meshgrid(*along, indexing="ij"), axis=-1)
    inside = on_plate(outline, grid.reshape(-1, 2), rest).reshape(counts)
    if not inside.any():
        raise ValueError(f"Input across must let the part lie on the plate at some place; got {across}")
    numbers = np.full(counts + 2, -1)
    numbers[1:-1, 1:-1][inside] = np.arange(inside.sum())
    around = [numbers[:-2, 1:-1], numbers[2:, 1:-1], numbers[1:-1, :-2], numbers[1:-1, 2:]]
    neighbours = np.stack([one[inside] for one in around], axis=1)
    return Squares(grid[inside], side, np.where(neighbours < 0, np.arange(len(neighbours))[:, None], neighbours))


def on_plate(outline: Outline, places: FloatArray, rest: PartAtRest | None) -> BoolArray:
    """Whether a part lies on the plate, at places (n, 2) [m] of its origin; a face with all of it."""
    inside = outline.gap(places) > 0
    if rest is not None and rest.face is not None:
        inside[inside] = _lies(outline, rest.face, rest.pose[2], places[inside])
    return inside


def _lies(outline: Outline, face: Face, heading: float, places: FloatArray) -> BoolArray:
    """Whether a face lies on the plate, at places (n, 2) [m] of its origin and a heading [rad]."""
    turn = np.array([[math.cos(heading), math.sin(heading)], [-math.sin(heading), math.cos(heading)]])
    on = outline.gap(places) >= face.radius
    for point in np.concatenate([face.corners, face.places]) @ turn:
        on &= outline.gap(places + point) >= 0
    return on


class Place(NamedTuple):
    """Where a part lies at rest, and under which law and gravity."""

    outline: Outline
    part: Micropart | Body
    friction: Contact
    gravity: float | Sequence[float]
    across: int  # squares along the outline's longer side
    tips: bool = True  # whether a face is lost where an edge lifts


def resting_of(rest: PartAtRest) -> Resting | None:
    """What says whether friction holds a part with a face; None of a point. The rim of a disc counts at 48 points."""
    face = rest.face
    if face is None:
        return None
    memory = rest.memory(np.array([rest.pose[:2]]), float(rest.times[0]))
    around = np.linspace(0.0, 2 * math.pi, 48, endpoint=False)[:, None]
    rim = face.radius * np.hstack([np.cos(around), np.sin(around)]) if face.radius else face.hull
    levers = rim @ face.unmoments @ np.array([[0.0, -1.0], [1.0, 0.0]])
    levers = np.concatenate([np.zeros((1, 2)), levers if face.linear and face.tips else np.zeros((0, 2))])
    return Resting(face, levers, memory.balance, memory.search)


def responses_of(rest: PartAtRest, points: FloatArray, moments: FloatArray) -> Callable[[], Iterable[FloatArray]]:
    """Of a part at rest at the places, moment by moment (n, 8) as of `find_responses`, of a face (n, 12).

    On a mid-plane that stretches slopes under a point are the material's, off by its strain. Responses are kept where
    they take little memory, else found again.
    """

    def of_point() -> Iterator[FloatArray]:
        surface, part = rest.surface, rest.part
        for time in moments.tolist():
            s = surface.evaluate(points, time)
            base = s.u_tt + surface.base_acceleration(time)
            fields = Fields(*map(np.ascontiguousarray, (s.w_tt, s.gradient, s.gradient_t, s.gradient_tt, base)))
            found = np.zeros((len(points), 8))
            find_responses(fields, part, found)
            yield found

    def of_face() -> Iterator[FloatArray]:
        for times in np.array_split(moments, math.ceil(12 * len(points) * len(moments) / BLOCK)):
            yield from rest.responses(points, times)

    find, width = (of_point, 8) if rest.face is None else (of_face, 12)
    if width * len(points) * len(moments) > MAX_KEPT:
        return find
    kept = list(find())
    return lambda: kept
