"""Where a lattice stands: which of its places are on the plate, and apart from each other and from other actuators."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Final, NamedTuple, Self

from coupling.case.actuators.drive import ActuatorCase
from coupling.case.actuators.lattice import LatticeCase
from coupling.case.actuators.lattice_values import Grid, Spot, actuators_at
from coupling.case.mistakes import Location, Mistake
from coupling.case.table import WRONG
from coupling.case.values import UNITS_REQUIRED, Condition, length_text, quoted

if TYPE_CHECKING:
    from meshes import PlateMesh

SAME_PLACE: Final = 1e-9
"""Places closer than this fraction of half the plate's longer side count as one."""

Place = tuple[float, float]


class Stand(NamedTuple):
    """A lattice on a plate, as far as its keys are right."""

    spots: Sequence[Spot]  # those that are not left out; none where not all are known
    actuators: tuple[ActuatorCase, ...]  # one at each; none where anything is wrong
    mistakes: list[Mistake]
    held: Sequence[Spot] | None  # where its actuators hold the plate, and do not push with a force; None: not known

    @classmethod
    def on(cls, values: Mapping[str, Any], mesh: PlateMesh | None, unit: str) -> Self:
        """A lattice on the plate of a mesh, None where that is not known.

        values: of the keys of a `LatticeCase`, WRONG for those that are not right.  unit: of lengths in messages.
        """
        grid = Grid.of(values)
        try:
            spots = _left(values, grid, mesh)
        except _NotKnownError as error:
            return cls((), (), error.mistakes, None)
        mistakes = _beyond_rim(spots, mesh, unit) if mesh and grid.whole else []
        actuators, wrong = actuators_at(spots, grid, values)
        spots = spots if grid.whole else []
        drivers = [key for key in LatticeCase.drivers if values[key] is not None]
        held = spots if "force" not in drivers else () if drivers == ["force"] else None
        mistakes += wrong
        return cls(spots, () if mistakes else actuators, mistakes, held if spots and drivers else None)

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


def outside(lattice: Mapping[str, Any], places: Sequence[Place]) -> str:
    """The condition of a lattice, as a file has it, that leaves some of its places out as well."""
    grid = Grid.of(dict(LatticeCase.model_validate(lattice, context=UNITS_REQUIRED)))
    spots = {(spot.x, spot.y): spot for spot in grid.spots}
    several = [key for key in ("row", "column") if lattice[f"{key}s"] > 1]
    left = [" or ".join(f"{key} != {getattr(spots[place], key)}" for key in several) for place in places]
    parts = [*([lattice["where"]] if "where" in lattice else []), *left]
    return " and ".join(f"({part})" for part in parts) if len(parts) > 1 else "".join(parts)


class _NotKnownError(Exception):
    """That there is no telling which places of a lattice have an actuator; `mistakes` say why, if that is not told."""

    def __init__(self, *mistakes: Mistake) -> None:
        self.mistakes = list(mistakes)


def _left(values: Mapping[str, Any], grid: Grid, mesh: PlateMesh | None) -> Sequence[Spot]:
    """The places that are not left out."""
    spots, margin, where = grid.spots, values["margin"], values["where"]
    if margin is WRONG or where is WRONG:
        raise _NotKnownError
    if margin is not None:
        if mesh is None or not grid.whole:
            raise _NotKnownError
        least = SAME_PLACE * half_size(mesh)
        needed = max(margin - least, mesh.least_gap)
        depth = gaps(mesh, [(spot.x, spot.y) for spot in spots])
        spots = [spot for spot, gap in zip(spots, depth, strict=True) if gap > needed]
        if not spots:
            raise _NotKnownError((("lattice", "margin"), "leaves no actuator on the plate"))
    return spots if where is None else _chosen(where, spots, grid)


def _chosen(where: Condition, spots: Sequence[Spot], grid: Grid) -> Sequence[Spot]:
    """The places at which a condition is true."""
    if not grid.tells(where):
        raise _NotKnownError
    chosen = []
    for spot in spots:
        try:
            chosen += [spot] if where.holds(grid.names(spot)) else []
        except ValueError as error:
            message = f"must be true or false for each actuator; {quoted(where.text)} {error} at {spot}"
            raise _NotKnownError((("lattice", "where"), message)) from None
    if not chosen:
        counted = {"rows", "columns"} <= grid.known
        message = f"must be true for one actuator or more; {quoted(where.text)} is true for none"
        raise _NotKnownError(*([(("lattice", "where"), message)] if counted else []))
    return chosen


def _beyond_rim(spots: Sequence[Spot], mesh: PlateMesh, unit: str) -> list[Mistake]:
    """That places are not inside the rim; nothing if all are."""
    depth = gaps(mesh, [(spot.x, spot.y) for spot in spots])
    outside = [(spot, gap) for spot, gap in zip(spots, depth, strict=True) if gap <= mesh.least_gap]
    if not outside:
        return []
    (spot, gap), *more = outside
    also = f", and {len(more)} more are not inside either" if more else ""
    inside, at = _inside(gap, mesh.least_gap, mesh, unit)
    return [(("lattice",), f"must have all its actuators {inside}; {spot} is {at}{also}; a margin leaves them out")]


def half_size(mesh: PlateMesh) -> float:
    """Half of the plate's longer side [m]."""
    return float((mesh.outline.box[1] - mesh.outline.box[0]).max()) / 2


def gaps(mesh: PlateMesh, places: Sequence[Place]) -> list[float]:
    """How far inside the rim places are [m], negative beyond it."""
    return mesh.outline.gap(places).tolist() if places else []


def must_be_inside(gap: float, least: float, mesh: PlateMesh, unit: str = "um") -> str:
    """What is wrong with a place so far inside the rim, where more than `least` is needed; both in m."""
    inside, at = _inside(gap, least, mesh, unit)
    return f"must be {inside}; got a point {at}"


def _inside(gap: float, least: float, mesh: PlateMesh, unit: str) -> tuple[str, str]:
    same = SAME_PLACE * half_size(mesh)
    if gap > same:
        return f"more than {length_text(least, unit)} inside the rim", f"{length_text(gap, unit)} inside it"
    return "inside the rim", f"{length_text(-gap, unit)} beyond it" if gap < -same else "on it"


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
