"""Coming off next to an actuator, which decides several figures, and which a point actuator exaggerates.

The curvature of equation (2) has no bound at the actuator. A part that slides by at a speed v needs the normal
acceleration v.H v to follow the surface; where that exceeds the pull-off our equations let it go. The paper's normal
force has no such term.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

from active_surface.arrays import FloatArray
from active_surface.paper.parameters import Parameters
from active_surface.paper.path import Path
from active_surface.paper.share import share_of

SPEED: Final = 0.2  # m/s
PLACES: Final = (5e-9, 1e-6, 10e-6, 50e-6)  # m from the actuator
FAST: Final = 650.0  # Hz
CLOSE: Final = 10e-6  # m
MICRO, NANO = 1e6, 1e9


def bending_pull(p: Parameters, away: ArrayLike, speed: float = SPEED) -> FloatArray:
    """v.H v [m/s^2] of a part that moves straight to or from an actuator at full stroke, at distances [m] from it."""
    curvature = 4 * p.stroke / p.radius**2 * (np.log(np.asarray(away) / p.radius) + 1)
    return np.asarray(curvature * speed**2)


def hardest(p: Parameters, frequency: float) -> float:
    """The largest acceleration [m/s^2] of an actuator that goes up and down at a frequency [Hz]."""
    return 10 / np.sqrt(3) * p.stroke * (2 * frequency * p.period_share) ** 2


def off_numbers(paths: Sequence[Path], actuators: ArrayLike) -> dict[str, Any]:
    """The share that comes off; of these the share within CLOSE of one of the actuators, median distance and speed."""
    away, speed = np.array([path.off_at(actuators) for path in paths]).T
    off = np.isfinite(away)
    if not off.any():
        return {"come_off": 0.0}
    return {
        "come_off": float(off.mean()), "close": float((away[off] <= CLOSE).mean()),
        "median_distance": float(np.median(away[off])), "median_speed": float(np.median(speed[off])),
    }  # fmt: skip


def off_said(paths: Sequence[Path], actuators: ArrayLike) -> str:
    """The same in words."""
    numbers = off_numbers(paths, actuators)
    text = f"{share_of(path.came_off for path in paths)} come off"
    if "close" not in numbers:
        return text
    return text + f", half of these within {length(numbers['median_distance'])} of an actuator"


def end_said(path: Path, actuators: ArrayLike) -> str:
    """How a path ends, in words."""
    if path.came_off:
        return f"comes off {length(path.off_at(actuators)[0])} from an actuator"
    if path.over_rim:
        return "goes over the rim"
    return "is not followed to the end" if path.unknown else "is on the surface in the end"


def length(metres: float) -> str:
    """A small length in words."""
    return f"{NANO * metres:.2g} nm" if metres < 0.1e-6 else f"{MICRO * metres:.2g} um"


def paragraph(p: Parameters) -> str:
    """What the page says of it."""
    pulls = ", ".join(
        f"{pull:.0f} m/s² at {length(away)}"
        for pull, away in zip(bending_pull(p, PLACES).tolist(), PLACES, strict=True)
    )
    return (
        "**Coming off next to an actuator.** A point actuator bends its surface without bound. A part that passes at "
        f"{SPEED:g} m/s at full stroke needs v.H v of equation (2) to follow: {pulls} from the actuator, where the "
        f"contact bears {p.friction.pull_off / p.mass:.0f} m/s². So in our equations parts come off next to "
        f"actuators, on lengths far below the {MICRO * p.contact_side:g} µm of the part. The paper's normal force has "
        "no v.H v, so that its scheme has nothing to lose them by there. Where that decides (figure 16 at 450 Hz, 17b, "
        "20 over the nearest actuator's profile and on the plate) it is a limit of the point model and says nothing "
        "about the paper; answers give the distance at which it happens. Micrometres away the surface's own "
        f"acceleration counts more: that of one actuator reaches {hardest(p, FAST):.0f} m/s² at {FAST:g} Hz.\n"
    ).replace(" um", " µm")
