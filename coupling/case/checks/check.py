"""Check the tables of a case against each other, and build the case's actuators and friction from them."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from coupling.case.actuators import SAME_PLACE, ActuatorCase, Place, actuators_of, gaps, half_size, must_be_inside
from coupling.case.checks.theories import check_theory, cycles_fault
from coupling.case.friction import TableCase
from coupling.case.plates import PLATFORM, PlateCase, PlatformCase, ShapeCase
from coupling.case.table import Faults, Location, Mistake, location_text
from coupling.case.tables import CaseTables
from coupling.case.values import length_text, unreadable
from coupling.suggestion import near

if TYPE_CHECKING:
    from meshes import PlateMesh


def build(tables: CaseTables, may_move: bool = False) -> dict[str, Any]:
    """The tables of a case: a lattice becomes actuators, and the points in the file of a friction law are read.

    may_move: accept that supports and actuators leave the plate free to move as a whole.
    Raises Faults with every mistake.
    """
    mistakes: list[Mistake] = []
    made, friction = tables.actuators, tables.friction
    try:
        if isinstance(friction, TableCase):
            friction = friction.with_points()
    except Faults as error:
        mistakes += error.mistakes
    plate = tables.plate
    if isinstance(plate, PlatformCase):
        mistakes += _platform(tables, plate)
    else:
        try:
            mesh = _mesh_of(plate)
            made += actuators_of(tables.lattice, mesh) if tables.lattice else ()
            mistakes += (misplaced := list(_places(tables, plate, mesh, made)))
            mistakes += check_theory(plate, tables.run, made, len(tables.actuators))
            if not (may_move or misplaced):
                mistakes += _held(plate, mesh, made)
        except Faults as error:
            mistakes += error.mistakes
    if wrong := cycles_fault(plate, made, tables.run.duration):
        mistakes.append((("run", "duration"), wrong))
    if mistakes:
        raise Faults(mistakes)
    return {**dict(tables), "actuators": made, "friction": friction, "lattice": None}


def _platform(tables: CaseTables, platform: PlatformCase) -> Iterator[Mistake]:
    for key in ("actuators", "lattice"):
        if getattr(tables, key):
            yield (key,), f"must not be given with {PLATFORM}, which moves as a whole"
    if tables.run.start == "steady":
        yield ("run", "start"), f'must be "rest" with {PLATFORM}, which does not vibrate; got "steady"'
    yield from platform.mistakes(tables.run.duration)


def _mesh_of(plate: PlateCase) -> PlateMesh:
    """The mesh for a plate's outline; raises Faults where there is none."""
    try:
        return plate.coarse_mesh
    except OSError as error:
        wrong = [unreadable(Path(str(error.filename)).name, error)]
    except ValueError as error:
        wrong = [
            re.sub(r"^Input \w+ of \w+ ", "", text).replace("\n  ", " ", 1).replace("\n  ", "; ")
            for text in re.split(r"\n(?=Input )", str(error))
        ]
    raise Faults((("plate", plate.outlined_by), message) for message in wrong)


def _places(tables: CaseTables, plate: PlateCase, mesh: PlateMesh, made: Sequence[ActuatorCase]) -> Iterator[Mistake]:
    """Yield what does not fit the plate's outline: names of boundaries, cells, actuators and part."""
    names = list(mesh.boundaries)
    for key in ("supports", "in_plane_supports"):
        supports = getattr(plate, key)
        for name in supports if isinstance(supports, dict) else ():
            if name not in names:
                meant = near(name, names)
                hint = f"did you mean {meant}? It" if meant else "it"
                yield ("plate", key, name), f"is no boundary of the plate; {hint} has {', '.join(names)}"
    free = [name for name, support in plate.supports_of(names).items() if support == "free"]
    if plate.tension and free:
        rims = f"{' and '.join(free)} {'is' if len(free) == 1 else 'are'} free"
        rule = "must be 0 if a boundary is free (a free edge carries no tension)"
        yield ("plate", "tension"), f"{rule}; got {plate.tension:g} N/m, and {rims}"
    if isinstance(plate, ShapeCase) and plate.cell_size is not None:
        least, most, got = plate.min_cell_size, plate.measures[0] / 2, f"; got {length_text(plate.cell_size)}"
        if plate.cell_size < least:
            yield ("plate", "cell_size"), f"must be at least {length_text(least)}{got}"
        if plate.cell_size > most * (1 + SAME_PLACE):
            limit = f"half of the plate's smallest width, {length_text(most)}"
            yield ("plate", "cell_size"), f"must not exceed {limit}{got}"
    alone = len(tables.actuators)
    if not made:
        yield ("actuators",), "must be at least one table, written [[actuators]]; got none"
    places: dict[Location, Place] = {("actuators", k, "position"): one.position for k, one in enumerate(made)}
    places |= {("part", "position"): tables.part.position}
    least = SAME_PLACE * half_size(mesh)
    for at, gap in zip(places, gaps(mesh, list(places.values())), strict=True):
        if gap <= mesh.least_gap:
            yield at, must_be_inside(gap, mesh)
    for one, other in _shared(list(places.values())[:-1], least):
        first = location_text(("actuators", one, "position"))
        if one >= alone:
            yield (
                ("lattice", "pitch"),
                f"must keep the actuators apart; numbers {one} and {other} are at one point",
            )
            return
        if other >= alone:
            yield ("actuators", one, "position"), "must differ from that of an actuator of the lattice"
        else:
            yield ("actuators", other, "position"), f"must differ from {first}; got the same point"


def _shared(places: Sequence[Place], least: float) -> Iterator[tuple[int, int]]:
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


def _held(plate: PlateCase, mesh: PlateMesh, made: Sequence[ActuatorCase]) -> Iterator[Mistake]:
    """Yield that nothing keeps the plate from moving as a whole, w = a + b x + c y."""
    supports = plate.supports_of(list(mesh.boundaries))
    if plate.foundation > 0 or "clamped" in supports.values():
        return
    held = [one.position for one in made if one.force is None]
    rims = [mesh.boundaries[name].ravel() for name, support in supports.items() if support == "simply-supported"]
    if not mesh.spans([*held, *(place for rim in rims for place in mesh.points[rim].tolist())]):
        needed = "fix a boundary, or use three actuators with strokes that are not in line"
        yield ("plate", "supports"), f"must not leave the plate free to move as a whole: {needed}"
    if plate.theory == "von-karman" and not rims and len(held) == 3 == len(made):
        same = "which tilt it without bending it; both theories are the same there"
        yield ("plate", "theory"), f'must be "linear" on a free plate with three actuators, {same}'
