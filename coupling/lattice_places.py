"""Where a lattice stands: which of its places are on the plate, and apart from each other and from other actuators."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Final, NamedTuple, Self

from coupling.case_lines import Location
from coupling.drive_case import ActuatorCase
from coupling.lattice_case import LatticeCase, Spot
from coupling.units import shown_length

if TYPE_CHECKING:
    from meshes import PlateMesh

SAME_PLACE: Final = 1e-9
"""Places closer than this fraction of half the plate's longer side count as one."""

Place = tuple[float, float]
Mistake = tuple[Location, str]


class Stand(NamedTuple):
    """A lattice on a plate."""

    spots: Sequence[Spot]  # those that are not left out
    actuators: tuple[ActuatorCase, ...]  # one at each; none where anything is wrong
    mistakes: list[Mistake]
    holds: bool  # whether its actuators hold the plate, and do not push with a force

    @classmethod
    def on(cls, lattice: LatticeCase, mesh: PlateMesh | None) -> Self:
        """A lattice on the plate of a mesh, None where that is not known."""
        spots, mistakes = _on_plate(lattice, mesh)
        # Where a margin counts from an unknown rim there is no telling at which places a formula must have a value.
        actuators, wrong = lattice.actuators([] if mesh is None and lattice.margin is not None else spots)
        mistakes += [(("lattice", key), message) for key, message in wrong]
        return cls(spots, () if mistakes else actuators, mistakes, lattice.force is None)

    def crowded(self, others: Mapping[Location, Place], least: float) -> Iterator[Mistake]:
        """Yield where its places are the same, and which others stand on one; least: m, how far apart they must be."""
        here = [(spot.x, spot.y) for spot in self.spots]
        for one, other in shared_places(here, least):
            at = f"{self.spots[other]} is at the same point as {self.spots[one]}"
            yield ("lattice", "pitch"), f"must keep the actuators apart; {at}"
            return
        for one, other in shared_places([*here, *others.values()], least):
            if one < len(here) <= other:
                at = f"must differ from that of {self.spots[one]} of the lattice"
                yield list(others)[other - len(here)], f"{at}; got the same point"


def _on_plate(lattice: LatticeCase, mesh: PlateMesh | None) -> tuple[list[Spot], list[Mistake]]:
    """The places that are not left out, and what is wrong with them as a whole."""
    if mesh is None:
        return lattice.spots, []
    least = SAME_PLACE * half_size(mesh)
    depth = gaps(mesh, [(spot.x, spot.y) for spot in lattice.spots])
    if lattice.margin is not None:
        needed = max(lattice.margin - least, least)
        spots = [spot for spot, gap in zip(lattice.spots, depth, strict=True) if gap > needed]
        return spots, [] if spots else [(("lattice", "margin"), "leaves no actuator on the plate")]
    outside = [(spot, gap) for spot, gap in zip(lattice.spots, depth, strict=True) if gap <= least]
    if not outside:
        return lattice.spots, []
    (spot, gap), *more = outside
    also = f", and {len(more)} more are not inside either" if more else ""
    message = (
        f"must have all its actuators inside the rim; {spot} is {beyond(gap, least)}{also}; a margin leaves them out"
    )
    return lattice.spots, [(("lattice",), message)]


def half_size(mesh: PlateMesh) -> float:
    """Half of the plate's longer side [m]."""
    return float((mesh.outline.box[1] - mesh.outline.box[0]).max()) / 2


def gaps(mesh: PlateMesh, places: Sequence[Place]) -> list[float]:
    """How far inside the rim places are [m], negative beyond it."""
    import numpy as np  # here, because reading a case is to be quick

    return [float(gap) for gap in mesh.outline.gap(np.reshape(places, (-1, 2)))] if places else []


def beyond(gap: float, least: float) -> str:
    """How far beyond the rim a place is, in words; on it within `least` [m]."""
    return f"{shown_length(-gap)} beyond it" if gap < -least else "on it"


def shared_places(places: Sequence[Place], least: float) -> Iterator[tuple[int, int]]:
    """Yield each place that is nearer than `least` [m] to an earlier one, after that."""
    cells: dict[Place, list[int]] = {}
    for k, (x, y) in enumerate(places):
        column, row = x // least, y // least
        around = [(column + i, row + j) for i in (-1, 0, 1) for j in (-1, 0, 1)]
        near = (one for cell in around for one in cells.get(cell, ()) if math.dist(places[one], (x, y)) < least)
        if (one := next(near, None)) is None:
            cells.setdefault((column, row), []).append(k)
        else:
            yield one, k
