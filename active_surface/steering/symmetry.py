"""Symmetry: the line that a part cannot leave, because everything that can push it is symmetric about it."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Final

import numpy as np
from scipy.spatial import cKDTree

from active_surface.arrays import FloatArray
from coupling.case import AnnulusCase, Case, DiscCase, EllipseCase, PlateCase, RectangleCase, length_text
from coupling.scene import section_of
from fem_plate import PlateSection

Direction = tuple[float, float]

ON_LINE: Final = 1e-12  # of the largest distance from the centre: tolerance of lying on the line
SAME_LAW: Final = 1e-9  # of the rigidity: materials with laws that differ by less are alike
ALONG: Final = ((1.0, 0.0), (0.0, 1.0))
DIAGONAL: Final = ((math.sqrt(0.5), math.sqrt(0.5)), (math.sqrt(0.5), -math.sqrt(0.5)))


def off_the_line(
    case: Case, plate: PlateCase, target: tuple[float, float], tolerance: float, movers: Sequence[int]
) -> Iterator[str]:
    """Yield a message if a target [m] lies off a line that the part cannot leave by more than a tolerance [m].

    movers: the numbers of the actuators that take part; all others rest.
    """
    lines = [line for line in _mirrors(case, plate, movers) if _keeps(case, line, movers)]
    if len(lines) > 1:
        away = math.dist(case.part.position, target)
        if away > tolerance:
            yield (
                "cannot be reached: nothing moves the part, which stands in the plate's centre with the same on all "
                f"sides, and the target is {length_text(away)} off it"
            )
        return
    for x, y in lines:
        away = abs(x * target[1] - y * target[0])
        if away > tolerance:
            angle = math.degrees(math.atan2(y, x)) % 180
            who = "one actuator moves" if len(movers) == 1 else f"these {len(movers)} actuators move"
            yield (
                f"cannot be reached: from this start {who} the part only along the line through the plate's centre at "
                f"{angle:.4g} degrees from x, and the target is {length_text(away)} off it"
            )


def _keeps(case: Case, line: Direction, movers: Sequence[int]) -> bool:
    """Whether the part lies on a line through the centre and nothing pushes it off, as its face may."""
    if case.part.face is not None:
        return False
    gravity = case.run.gravity if isinstance(case.run.gravity, tuple) else (0.0, 0.0, 0.0)
    every = np.array([actuator.position for actuator in case.actuators])
    farthest = float(np.hypot(*np.array([case.part.position, *every]).T).max())
    moving = np.isin(np.arange(len(every)), movers)
    standing = np.array([case.part.position, *every[moving]])
    pushes = np.array([case.part.velocity, gravity[:2]])
    if (_across(line, standing) > ON_LINE * farthest).any():
        return False
    if (_across(line, pushes) > ON_LINE * np.hypot(*pushes.T)).any():
        return False
    resting = [(actuator.force is None, actuator.stiffness) for actuator in case.actuators]
    return _is_symmetric(every[~moving], [resting[k] for k in np.flatnonzero(~moving)], line, ON_LINE * farthest)


def _across(line: Direction, vectors: FloatArray) -> FloatArray:
    """The components of vectors (n, 2) across a line."""
    return np.asarray(np.abs(line[0] * vectors[:, 1] - line[1] * vectors[:, 0]))


def _is_symmetric(places: FloatArray, kinds: Sequence[object], line: Direction, tolerance: float) -> bool:
    """Whether the mirror image of each place (n, 2) [m] is, within `tolerance` [m], a place of the same kind."""
    if not len(places):
        return True
    along = np.array(line)
    away, other = cKDTree(places).query(2 * np.outer(places @ along, along) - places)
    return bool((away <= tolerance).all()) and all(kinds[k] == kinds[j] for k, j in enumerate(other))


def _mirrors(case: Case, plate: PlateCase, movers: Sequence[int]) -> Iterator[Direction]:
    """Yield the directions of the axes of symmetry of a plate and its material; for a round one those that matter."""
    section = section_of(plate)
    for line in _mirrors_of_outline(case, plate, movers):
        mirrored = section if isinstance(section, PlateSection) else section.mirrored(line)
        if np.allclose(mirrored.law, section.law, rtol=0, atol=SAME_LAW):
            yield line


def _mirrors_of_outline(case: Case, plate: PlateCase, movers: Sequence[int]) -> Iterator[Direction]:
    """Yield the same of the outline with its supports."""
    if isinstance(plate, (DiscCase, AnnulusCase)) or (
        isinstance(plate, EllipseCase) and plate.semi_axis_x == plate.semi_axis_y
    ):
        places = np.array([case.part.position, *(case.actuators[k].position for k in movers)])
        x, y = places[np.argmax(np.hypot(*places.T))].tolist()
        radius = math.hypot(x, y)
        # In the centre a part at rest stays, on every line.
        yield from [(x / radius, y / radius)] if radius > 0 else (*ALONG, *DIAGONAL)
    elif isinstance(plate, EllipseCase):
        yield from ALONG
    elif isinstance(plate, RectangleCase):
        left, right, bottom, top = plate.supports_of(["left", "right", "bottom", "top"]).values()
        square = plate.width == plate.height
        same = (bottom == top, left == right, square and (left, right) == (bottom, top))
        kept = (*same, square and (left, right) == (top, bottom))
        yield from (line for line, good in zip((*ALONG, *DIAGONAL), kept, strict=True) if good)
