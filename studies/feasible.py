"""Feasible: where on a surface slip starts while the part stays attached, and how that changes with frequency.

A part at rest at a place slips there while the pull without friction exceeds what friction holds, and stays attached
while its net load lies between minus pull-off and the end of the friction law (`particle.motion` with v = 0). Two areas
follow from that, both over one window of time:

- feasible: places where it slips at that moment, and where it would not have come off at any moment of the window;
- slipping: places where it slips at that moment and is attached then, whatever happens there at other moments.

Drives that run `factor` times as fast leave shapes and slopes as they are and multiply accelerations by its square.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from meshes import Outline
from particle import Micropart, SurfaceMotion
from particle.friction import Contact
from particle.motion import Part
from particle.slipping import count_slips, find_lost

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

ACROSS: Final = 120  # places along the longer side of the plate
PER_STROKE: Final = 48  # moments in the shortest stroke
MOST_MOMENTS: Final = 4096


class Curves(NamedTuple):
    """Areas over the factors (F,) that the drives' frequencies are multiplied with."""

    peak: FloatArray  # (F,) m^2, the largest at any moment
    integral: FloatArray  # (F,) m^2 s, over the window


@dataclass(frozen=True, eq=False)
class Feasible:
    """Where a part slips without coming off, over factors (F,) of frequency, moments (K,) and places (n,)."""

    factors: FloatArray  # (F,)
    window: float  # s, at a factor of 1; it is shorter by the factor
    moments: FloatArray = field(repr=False)  # (K,) s, at a factor of 1
    points: FloatArray = field(repr=False)  # (n, 2) m, centres of squares
    spacing: float  # m, the squares' side
    feasible: Curves = field(repr=False)
    slipping: Curves = field(repr=False)
    lost_area: FloatArray = field(repr=False)  # (F,) m^2, where it comes off at some moment
    shares: FloatArray = field(repr=False)  # (n,) of the window's time in which the part slips attached, at factor 1
    lost: BoolArray = field(repr=False)  # (n,) whether it comes off at some moment, at factor 1
    over_time: FloatArray = field(repr=False)  # (K,) m^2, the feasible area at factor 1

    @property
    def at_one(self) -> int:
        """The row of the factor 1."""
        return int(np.argmin(np.abs(self.factors - 1)))


def find_feasible(
    surface: SurfaceMotion,
    outline: Outline,
    part: Micropart,
    friction: Contact,
    window: float,
    factors: FloatArray,
    gravity: float | Sequence[float] = 9.80665,
    across: int = ACROSS,
) -> Feasible:
    """The feasible areas of a part at rest on a surface within an outline, over a window [s] from the start.

    factors: (F,) what the drives' frequencies are multiplied with; 1 is added if it is not among them.
    gravity: as for `particle.simulate`.  across: places along the longer side.
    The part's place and velocity do not matter.
    """
    factors = np.unique(np.append(np.asarray(factors, dtype=float), 1.0))
    points, spacing = places(outline, across)
    stroke_time = float(surface.drives.stroke_time.min(initial=window))
    count = int(np.clip(np.ceil(PER_STROKE * window / stroke_time), PER_STROKE, MOST_MOMENTS))
    moments = window * (np.arange(count) + 0.5) / count
    vector = np.array([0.0, 0.0, -gravity]) if isinstance(gravity, (int, float)) else np.array(gravity, dtype=float)
    resting = Part(part.mass, -float(vector[2]), float(vector[0]), float(vector[1]), part.squeeze, friction.law)
    one = int(np.argmin(np.abs(factors - 1)))
    lost = np.zeros((len(factors), len(points)), dtype=np.bool_)
    for time in moments.tolist():
        state = surface.evaluate(points, time)
        find_lost(state.w_tt, state.gradient, resting, factors, lost)
    counts = np.zeros((2, len(factors), count))
    slips = np.zeros(len(points))
    for k, time in enumerate(moments.tolist()):
        state = surface.evaluate(points, time)
        count_slips(state.w_tt, state.gradient, resting, factors, lost, counts[:, :, k], slips, one)
    areas = counts * spacing**2
    step = window / count
    curves = [Curves(area.max(axis=1), area.sum(axis=1) * step / factors) for area in areas]
    return Feasible(
        factors, window, moments, points, spacing, curves[0], curves[1], lost.sum(axis=1) * spacing**2,
        slips / count, lost[one], areas[0, one],
    )  # fmt: skip


def places(outline: Outline, across: int) -> tuple[FloatArray, float]:
    """The centres (n, 2) [m] of squares that cover what the outline encloses, and their side [m]."""
    low, high = outline.box
    spacing = float((high - low).max()) / across
    counts = np.ceil((high - low) / spacing - 1e-9).astype(int)
    sides = [
        middle + spacing * (np.arange(n) - (n - 1) / 2) for middle, n in zip((low + high) / 2, counts, strict=True)
    ]
    grid = np.stack(np.meshgrid(*sides, indexing="ij"), axis=-1).reshape(-1, 2)
    return grid[outline.gap(grid) > 0], spacing
