"""Reach: the line that a part cannot leave, because plate, actuators and its start are the same on both sides of it."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Final

import numpy as np

from coupling.case import Case
from coupling.plate_case import AnnulusCase, DiscCase, EllipseCase, PlateCase, RectangleCase
from coupling.units import shown_length

ON_LINE: Final = 1e-12  # of the farthest place: nearer counts as on the line
ALONG: Final = ((1.0, 0.0), (0.0, 1.0))


def off_the_line(
    case: Case, plate: PlateCase, target: tuple[float, float], tolerance: float, count: int
) -> Iterator[str]:
    """Yield that a target [m] is farther than a tolerance [m] off a line that the part cannot leave, if there is one.

    count: of the actuators that move it.
    """
    for x, y in _lines(case, plate):
        away = abs(x * target[1] - y * target[0])
        if away > tolerance:
            angle = math.degrees(math.atan2(y, x)) % 180
            who = "one actuator moves" if count == 1 else f"these {count} actuators move"
            yield (
                f"cannot be reached: from this start {who} the part only along the line through the plate's centre at "
                f"{angle:.4g} degrees from x, and the target is {shown_length(away)} off it"
            )
            return


def _lines(case: Case, plate: PlateCase) -> Iterator[tuple[float, float]]:
    """Yield the directions of the lines through the centre on which everything is that can push the part."""
    gravity = case.run.gravity if isinstance(case.run.gravity, tuple) else (0.0, 0.0, 0.0)
    places = np.array([case.part.position, *(actuator.position for actuator in case.actuators)])
    pushes = np.array([case.part.velocity, gravity[:2]])
    most = float(np.hypot(*places.T).max())
    lines = list(_mirrors(plate))
    if isinstance(plate, (DiscCase, AnnulusCase)):
        x, y = places[np.argmax(np.hypot(*places.T))].tolist()
        # In the centre itself a part at rest stays: on every line.
        lines = [(x / most, y / most)] if most > 0 else list(ALONG)
    for x, y in lines:
        away, aside = (np.abs(x * vectors[:, 1] - y * vectors[:, 0]) for vectors in (places, pushes))
        if (away <= ON_LINE * most).all() and (aside == 0).all():
            yield x, y


def _mirrors(plate: PlateCase) -> Iterator[tuple[float, float]]:
    """Yield the axes, as directions, about which a plate is the same on both sides."""
    if isinstance(plate, EllipseCase):
        yield from ALONG
    if isinstance(plate, RectangleCase):
        held = plate.supports_of(["left", "right", "bottom", "top"])
        for axis, one, other in zip(ALONG, ("bottom", "left"), ("top", "right"), strict=True):
            if held[one] == held[other]:
                yield axis
