"""What of a case must fit together: whether the plate has an outline or a motion, and everything its place on it."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated, Any, TypeVar

from pydantic import BaseModel, Field, ValidationError, ValidatorFunctionWrapHandler, WrapValidator

from coupling.case.any_plate import outline_of
from coupling.case.csv_columns import unreadable
from coupling.case.drive import ActuatorCase
from coupling.case.lattice import LatticeCase
from coupling.case.lattice_places import SAME_PLACE, Place, Stand, beyond, gaps, half_size, shared_places
from coupling.case.lines import Location, shown_location
from coupling.case.plate import PlateCase, ShapeCase, Supports
from coupling.case.platform import platform_of
from coupling.case.units import Length, Point, Time, shown, shown_length, written_unit
from coupling.suggestion import near

if TYPE_CHECKING:
    from meshes import PlateMesh

Mistake = tuple[Location, str]
Mistakes = Iterator[Mistake]
_T = TypeVar("_T")


def _none_if_wrong(value: Any, handler: ValidatorFunctionWrapHandler) -> Any:
    try:
        return handler(value)
    except ValidationError:
        return None


_IfValid = Annotated[_T | None, WrapValidator(_none_if_wrong)]


class _Plate(BaseModel, from_attributes=True):
    supports: _IfValid[Supports] = "clamped"
    written_supports: Any = Field(default=None, validation_alias="supports")
    cell_size: _IfValid[Annotated[Length, Field(gt=0)]] = None
    written: Any = Field(default=None, validation_alias="cell_size")


class _Spot(BaseModel, from_attributes=True):
    position: _IfValid[Point] = None
    written: Any = Field(default=None, validation_alias="position")
    force: Any = None


class _Run(BaseModel, from_attributes=True):
    duration: _IfValid[Time] = None


class Places(BaseModel, from_attributes=True):
    """The places in a case; each is None where it is missing or wrong, whatever else is."""

    plate: Any = None
    actuators: _IfValid[tuple[_IfValid[_Spot], ...]] = None
    lattice: Any = None
    part: _IfValid[_Spot] = None
    run: _IfValid[_Run] = None

    def check(self, context: Any = None) -> tuple[tuple[ActuatorCase, ...], list[Mistake]]:
        """The actuators of the lattice, none where that is wrong, and where any place is wrong, and why.

        context: that of the tables' validation.
        """
        platform = platform_of(self.plate, context)
        if platform:
            return (), [*self._beside_platform(), *platform.mistakes(self.run.duration if self.run else None)]
        mistakes: list[Mistake] = []
        if self.actuators == () and self.lattice is None:
            mistakes.append((("actuators",), "must be at least one table, written [[actuators]]; got none"))
        plate = outline_of(self.plate, context)
        mesh, wrong = _mesh(plate) if plate else (None, [])
        mistakes += [(("plate", plate.outlined_by), message) for message in wrong] if plate else []
        stand = None
        if isinstance(self.lattice, (dict, LatticeCase)):
            unit = written_unit(self.lattice.get("pitch") if isinstance(self.lattice, dict) else None)
            stand = Stand.on(LatticeCase.values_of(self.lattice, context), mesh, unit)
            mistakes += stand.mistakes
        if plate and mesh:
            given = _Plate.model_validate(self.plate, context=context)
            mistakes += self._in_plate(plate, mesh, given, stand)
        return (stand.actuators if stand else ()), mistakes

    def _beside_platform(self) -> Mistakes:
        for key, given in (("actuators", self.actuators != ()), ("lattice", self.lattice is not None)):
            if given:
                yield (key,), 'must not be given with shape = "platform", which moves as a whole'

    def _in_plate(self, plate: PlateCase, mesh: PlateMesh, given: _Plate, stand: Stand | None) -> Mistakes:
        """Yield what does not fit the plate of a mesh."""
        if isinstance(plate, ShapeCase) and given.cell_size is not None:
            most = plate.measures[0] / 2
            if given.cell_size > most * (1 + SAME_PLACE):
                limit = f"half of the plate's smallest width, {shown_length(most, written_unit(given.written))}"
                got = shown(given.written) if isinstance(given.written, str) else shown_length(given.written)
                yield ("plate", "cell_size"), f"must not exceed {limit}; got {got}"
        names = list(mesh.boundaries)
        supports = given.written_supports if isinstance(given.written_supports, dict) else {}
        for name in (name for name in supports if name not in names):
            meant = near(name, names)
            hint = f"did you mean {meant}? " if meant else ""
            has = f"It has {', '.join(names)}" if hint else f"it has {', '.join(names)}"
            yield ("plate", "supports", name), f"is no boundary of the plate; {hint}{has}"
        spots = [(("actuators", index), spot) for index, spot in enumerate(self.actuators or ()) if spot]
        places: dict[Location, Place] = {(*table, "position"): spot.position for table, spot in spots if spot.position}
        part: dict[Location, Place] = (
            {("part", "position"): self.part.position} if self.part and self.part.position else {}
        )
        least = SAME_PLACE * half_size(mesh)
        written: dict[Location, Any] = {(*table, "position"): spot.written for table, spot in spots}
        if self.part:
            written["part", "position"] = self.part.written
        inside: dict[Location, Place] = places | part
        for location, gap in zip(inside, gaps(mesh, list(inside.values())), strict=True):
            if gap <= least:
                unit = written_unit(written[location])
                yield location, f"must be inside the rim; got a point {beyond(gap, least, unit)}"
        for one, other in shared_places(list(places.values()), least):
            here, there = (list(places)[k] for k in (one, other))
            yield there, f"must differ from {shown_location(here)}; got the same point"
        if stand:
            yield from stand.crowded(places, least)
        held = [spot.position for _, spot in spots if spot.position and spot.force is None]
        known = len(held) == len(places) - sum(spot.force is not None for _, spot in spots)
        if stand and stand.held:
            held += [(spot.x, spot.y) for spot in stand.held]
        known &= self.actuators is not None and (self.lattice is None or (stand is not None and stand.held is not None))
        if given.supports is not None and known:
            yield from _rigid_motion(plate.model_copy(update={"supports": given.supports}), mesh, held)


def _mesh(plate: PlateCase) -> tuple[PlateMesh | None, list[str]]:
    """The mesh for a plate's outline, or why there is none."""
    try:
        return plate.coarse_mesh, []
    except OSError as error:
        return None, [unreadable(str(error.filename), error)]
    except ValueError as error:
        return None, [re.sub(r"^Input \w+ of \w+ ", "", line) for line in str(error).splitlines()]


def _rigid_motion(plate: PlateCase, mesh: PlateMesh, held: list[tuple[float, float]]) -> Mistakes:
    """Yield that nothing keeps the plate from moving as a whole, w = a + b x + c y.

    held: (x, y) m of the actuators that keep their height.
    """
    import numpy as np

    supports = plate.supports_of(list(mesh.boundaries))
    if "clamped" in supports.values():
        return
    rows = [mesh.boundaries[name].ravel() for name, support in supports.items() if support == "simply-supported"]
    points = np.concatenate([np.reshape(held, (-1, 2)), *(mesh.points[row] for row in rows)]) / mesh.size
    if len(points) < 3 or np.linalg.matrix_rank(np.insert(points, 0, 1.0, axis=1), tol=1e-6) < 3:
        needed = "a boundary that is not free, or three actuators with a stroke that are not in a line"
        yield ("plate", "supports"), f"leave the plate free to move as a whole; it takes {needed}"
