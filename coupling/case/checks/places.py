"""Checking: whether all places of a case are on its plate, apart from each other, and hold it."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from coupling.case.actuators import (
    SAME_PLACE,
    ActuatorCase,
    LatticeCase,
    Place,
    Stand,
    gaps,
    half_size,
    must_be_inside,
    shared_places,
)
from coupling.case.checks.parts import MAY_MOVE, Parts
from coupling.case.checks.theories import check_theory
from coupling.case.mistakes import Location, Mistake, location_text
from coupling.case.plates import PlateCase, ShapeCase
from coupling.case.table import right_value
from coupling.case.tables import PartCase
from coupling.case.values import length_text, quoted, unreadable, written_unit
from coupling.suggestion import near

if TYPE_CHECKING:
    from meshes import PlateMesh

Mistakes = Iterator[Mistake]


def mesh_of(plate: PlateCase) -> tuple[PlateMesh | None, list[Mistake]]:
    """The mesh for a plate's outline, or why there is none."""
    try:
        return plate.coarse_mesh, []
    except OSError as error:
        wrong = [unreadable(Path(str(error.filename)).name, error)]
    except ValueError as error:
        wrong = [
            re.sub(r"^Input \w+ of \w+ ", "", text).replace("\n  ", " ", 1).replace("\n  ", "; ")
            for text in re.split(r"\n(?=Input )", str(error))
        ]
    return None, [(("plate", plate.outlined_by), message) for message in wrong]


def stand_of(parts: Parts, mesh: PlateMesh | None) -> Stand | None:
    """Where the lattice stands; None where there is none."""
    lattice, written = parts.tables.get("lattice"), parts.written.get("lattice")
    if not isinstance(lattice, (dict, LatticeCase)):
        return None
    unit = written_unit(written.get("pitch") if isinstance(written, dict) else None)
    return Stand.on(LatticeCase.values_of(lattice, parts.context), mesh, unit)


def check_places(parts: Parts, outline: PlateCase, mesh: PlateMesh, stand: Stand | None) -> Mistakes:
    """Yield what does not fit the plate, or fit the rest of what is on it.

    outline: the plate as far as that goes.  mesh: for that.
    """
    plate, written_plate = parts.tables["plate"], parts.written["plate"]
    yield from _cell_size(outline, right_value(ShapeCase, "cell_size", plate, parts.context), written_plate)
    for key in ("supports", "in_plane_supports"):
        yield from _boundary_names(key, _written(plate, key), list(mesh.boundaries))
    spots = [
        _Spot.of(("actuators", index), ActuatorCase, *both, parts.context)
        for index, both in enumerate(parts.items("actuators"))
        if isinstance(both[0], (dict, ActuatorCase))
    ]
    part = _Spot.of(("part",), PartCase, parts.tables.get("part"), parts.written.get("part"), parts.context)
    least = SAME_PLACE * half_size(mesh)
    yield from _beyond_rim([spot for spot in spots if spot.place], mesh, mesh.least_gap)
    yield from _beyond_rim([part] if part.place else [], mesh, least)
    places = {spot.location: spot.place for spot in spots if spot.place}
    for one, other in shared_places(list(places.values()), least):
        here, there = (list(places)[k] for k in (one, other))
        yield there, f"must differ from {location_text(here)}; got the same point"
    if stand:
        yield from stand.crowded(places, least)
    yield from check_theory(parts, len(spots) + (len(stand.spots) if stand else 0))
    supports = right_value(PlateCase, "supports", plate, parts.context, "clamped")
    held = _held(parts, spots, stand)
    if supports is not None:
        supported = outline.model_copy(update={"supports": supports})
        yield from _free_tension(
            supported, mesh, right_value(PlateCase, "tension", plate, parts.context, 0.0), written_plate
        )
        rests = right_value(PlateCase, "foundation", plate, parts.context, 0.0)
        if held is not None and rests is not None and rests <= 0 and not (parts.context or {}).get(MAY_MOVE):
            yield from _rigid_motion(supported, mesh, held)
            stretches = right_value(PlateCase, "theory", plate, parts.context) == "von-karman"
            free = set(supported.supports_of(list(mesh.boundaries)).values()) == {"free"}
            if stretches and free and len(held) == 3 == len(spots) + (len(stand.spots) if stand else 0):
                yield (
                    ("plate", "theory"),
                    'must be "linear" on a free plate with three actuators, which tilt it without bending it; both '
                    "theories are the same there",
                )


class _Spot(NamedTuple):
    """Where an actuator or the part stands."""

    location: Location  # of its position
    place: Place | None  # m, None where it is wrong
    written: Any  # the same as text
    pushes: bool  # with a force, and does not hold the plate

    @classmethod
    def of(cls, table: Location, model: Any, value: Any, written: Any, context: Any) -> _Spot:
        place = right_value(model, "position", value, context)
        return cls((*table, "position"), place, _written(written, "position"), _written(value, "force") is not None)


def _written(table: Any, key: str) -> Any:
    return table.get(key) if isinstance(table, dict) else getattr(table, key, None)


def _cell_size(outline: PlateCase, cell_size: float | None, plate: Any) -> Mistakes:
    if not isinstance(outline, ShapeCase) or cell_size is None:
        return
    most, written = outline.measures[0] / 2, _written(plate, "cell_size")
    got = quoted(written) if isinstance(written, str) else length_text(written)
    if cell_size < (least := outline.min_cell_size):
        yield ("plate", "cell_size"), f"must be at least {length_text(least, written_unit(written))}; got {got}"
    if cell_size > most * (1 + SAME_PLACE):
        limit = f"half of the plate's smallest width, {length_text(most, written_unit(written))}"
        yield ("plate", "cell_size"), f"must not exceed {limit}; got {got}"


def _free_tension(outline: PlateCase, mesh: PlateMesh, tension: float | None, plate: Any) -> Mistakes:
    free = [name for name, support in outline.supports_of(list(mesh.boundaries)).items() if support == "free"]
    if tension and free:
        got = quoted(_written(plate, "tension"))
        rims = f"{' and '.join(free)} {'is' if len(free) == 1 else 'are'} free"
        yield (
            ("plate", "tension"),
            f"must be 0 where a boundary is free, as a free rim carries none; got {got}, and {rims}",
        )


def _boundary_names(key: str, supports: Any, names: list[str]) -> Mistakes:
    for name in supports if isinstance(supports, dict) else ():
        if name not in names:
            meant = near(name, names)
            hint = f"did you mean {meant}? " if meant else ""
            has = f"It has {', '.join(names)}" if hint else f"it has {', '.join(names)}"
            yield ("plate", key, name), f"is no boundary of the plate; {hint}{has}"


def _beyond_rim(spots: Sequence[_Spot], mesh: PlateMesh, least: float) -> Mistakes:
    """Yield that places are not inside the rim by more than `least` [m]."""
    for spot, gap in zip(spots, gaps(mesh, [spot.place for spot in spots if spot.place]), strict=True):
        if gap <= least:
            yield spot.location, must_be_inside(gap, least, mesh, written_unit(spot.written))


def _held(parts: Parts, spots: Sequence[_Spot], stand: Stand | None) -> list[Place] | None:
    """Where actuators hold the plate; None where that is not known."""
    known = isinstance(parts.tables.get("actuators"), (list, tuple))
    known &= parts.tables.get("lattice") is None or (stand is not None and stand.held is not None)
    holding = [spot.place for spot in spots if not spot.pushes]
    held = [place for place in holding if place]
    if not known or len(held) < len(holding):
        return None
    return held + [(spot.x, spot.y) for spot in (stand.held or () if stand else ())]


def _rigid_motion(plate: PlateCase, mesh: PlateMesh, held: Sequence[Place]) -> Mistakes:
    """Yield that nothing keeps the plate from moving as a whole, w = a + b x + c y.

    held: (x, y) m of the actuators that keep their height.
    """
    supports = plate.supports_of(list(mesh.boundaries))
    if "clamped" in supports.values():
        return
    rims = [mesh.boundaries[name].ravel() for name, support in supports.items() if support == "simply-supported"]
    if not mesh.spans([*held, *(place for rim in rims for place in mesh.points[rim].tolist())]):
        needed = "a boundary that is not free, or three actuators with a stroke that are not in a line"
        yield ("plate", "supports"), f"leave the plate free to move as a whole; it takes {needed}"
