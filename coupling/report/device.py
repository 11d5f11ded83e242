"""The device in words: what a case's plate, actuators and part are."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from common import count, joined, quantity_text
from coupling.case import (
    AnnulusCase,
    Case,
    DiscCase,
    EllipseCase,
    MotionCase,
    PlateCase,
    PlatformCase,
    PolygonCase,
    RectangleCase,
    RegularPolygonCase,
)

GRAMS: Final = 1e3  # in a kg
HELD: Final = {"clamped": "clamped", "simply-supported": "simply supported", "free": "free"}


def device(case: Case, parts: int = 1) -> str:
    """What a case is, for a title: the plate's outline, size, thickness and stiffness, its actuators, part or parts."""
    part = f"a part of {quantity_text(GRAMS * case.part.mass, 'g')}"
    part += "" if case.part.size is None else f", {quantity_text(case.part.size, 'm')} wide"
    part = part if parts == 1 else f"{parts} parts"
    if isinstance(case.plate, PlatformCase):
        return f"A flat, rigid platform, {_moved(case.plate)}, under {part}"
    return f"{_plate(case.plate)}, pushed from below by {count(len(case.actuators), 'actuator')} to move {part}"


def _plate(plate: PlateCase) -> str:
    shape, size = _outline(plate)
    held = f"{HELD[plate.supports]} " if isinstance(plate.supports, str) else ""
    article = "An" if (held or shape)[0] in "aeiou" else "A"
    sides = "" if held else f", {_sides(plate)}"
    turned = f", turned by {math.degrees(plate.wafer_angle):g} degrees" if plate.wafer_angle else ""
    stiffness = f"cut from a ({plate.wafer}) wafer{turned}"
    if plate.youngs_modulus is not None:
        stiffness = f"Young's modulus {quantity_text(plate.youngs_modulus, 'Pa')}"
    bends = " (it bends and stretches)" if plate.theory == "von-karman" else ""
    thick = f"{quantity_text(plate.thickness, 'm')} thick"
    rests = f", on a foundation of {plate.foundation:.4g} N/m^3" if plate.foundation else ""
    return f"{article} {held}{shape} {size}{sides}, {thick}, {stiffness}{bends}{rests}"


def _outline(plate: PlateCase) -> tuple[str, str]:
    """The outline and its size."""
    if isinstance(plate, DiscCase):
        return "disc", f"{quantity_text(2 * plate.radius, 'm')} across"
    if isinstance(plate, AnnulusCase):
        hole = quantity_text(2 * plate.inner_radius, "m")
        return "disc", f"{quantity_text(2 * plate.outer_radius, 'm')} across with a hole of {hole}"
    if isinstance(plate, RectangleCase):
        return "rectangle", _by(plate.width, plate.height)
    if isinstance(plate, EllipseCase):
        return "ellipse", _by(2 * plate.semi_axis_x, 2 * plate.semi_axis_y)
    if isinstance(plate, RegularPolygonCase):
        return (
            f"regular polygon of {plate.sides} sides",
            f"within a circle {quantity_text(2 * plate.radius, 'm')} across",
        )
    if isinstance(plate, PolygonCase):
        return f"polygon of {len(plate.corners)} corners", _by(*np.ptp(plate.corners, axis=0).tolist())
    return "plate from a mesh file", _by(*np.ptp(plate.coarse_mesh.outline.box, axis=0).tolist())


def _by(along: float, across: float) -> str:
    return f"of {quantity_text(along, 'm')} by {quantity_text(across, 'm')}"


def _sides(plate: PlateCase) -> str:
    """How each boundary is held, where these have names."""
    assert not isinstance(plate.supports, str)
    by_support: dict[str, list[str]] = {}
    for boundary, support in plate.supports.items():
        by_support.setdefault(HELD[support], []).append(boundary)
    return "; ".join(f"{support} at {joined(names)}" for support, names in by_support.items())


def _moved(platform: PlatformCase) -> str:
    """What moves a platform."""
    if isinstance(platform.motion, MotionCase):
        axes = [name for name in ("x", "y", "z") if getattr(platform.motion, name) is not None]
        ways = [f"shaken along {joined(axes)}"] if axes else []
        ways += ["turned"] if platform.motion.turn is not None else []
        return joined(ways or ["which stands still"])
    return "which stands still" if platform.motion is None else "moved as was measured"
