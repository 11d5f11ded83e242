"""What of a case must fit together: whether the plate has an outline or a motion, and everything its place on it."""

from __future__ import annotations

import difflib
import math
import re
from collections.abc import Iterator, Sequence
from itertools import combinations
from typing import TYPE_CHECKING, Annotated, Any, Final, TypeVar

from pydantic import BaseModel, Field, ValidationError, ValidatorFunctionWrapHandler, WrapValidator

from coupling.any_plate import outline_of
from coupling.case_lines import Location, shown_location
from coupling.plate_case import PlateCase, ShapeCase, Supports
from coupling.platform_case import platform_of
from coupling.units import Length, Point, Time, shown_length

if TYPE_CHECKING:
    from meshes import PlateMesh

SAME_PLACE: Final = 1e-9
"""Places closer than this fraction of half the plate's longer side count as one."""

Mistakes = Iterator[tuple[Location, str]]
_T = TypeVar("_T")


def _none_if_wrong(value: Any, handler: ValidatorFunctionWrapHandler) -> Any:
    try:
        return handler(value)
    except ValidationError:
        return None


_IfValid = Annotated[_T | None, WrapValidator(_none_if_wrong)]


class _Plate(BaseModel, from_attributes=True):
    supports: _IfValid[Supports] = "clamped"
    cell_size: _IfValid[Annotated[Length, Field(gt=0)]] = None


class _Spot(BaseModel, from_attributes=True):
    position: _IfValid[Point] = None
    force: Any = None


class _Run(BaseModel, from_attributes=True):
    duration: _IfValid[Time] = None


class Places(BaseModel, from_attributes=True):
    """The places in a case; each is None where it is missing or wrong, whatever else is."""

    plate: Any = None
    actuators: _IfValid[tuple[_IfValid[_Spot], ...]] = None
    part: _IfValid[_Spot] = None
    run: _IfValid[_Run] = None

    def mistakes(self, context: Any = None) -> Mistakes:
        """Yield where a place is wrong, and why; `context` is that of the tables' validation."""
        platform = platform_of(self.plate, context)
        if platform:
            if self.actuators != ():
                yield ("actuators",), 'must not be given with shape = "platform", which moves as a whole'
            yield from platform.mistakes(self.run.duration if self.run else None)
            return
        if self.actuators == ():
            yield ("actuators",), "must be at least one table, written [[actuators]]; got none"
        spots = [(("actuators", index), spot) for index, spot in enumerate(self.actuators or ()) if spot]
        plate = outline_of(self.plate, context)
        if plate is None:
            return
        try:
            mesh = plate.coarse_mesh
        except OSError as error:
            yield ("plate", plate.outlined_by), f"cannot be read: {(error.strerror or str(error)).lower()}"
            return
        except ValueError as error:
            for line in str(error).splitlines():
                yield ("plate", plate.outlined_by), re.sub(r"^Input \w+ of \w+ ", "", line)
            return
        yield from self._in_plate(plate, mesh, _Plate.model_validate(self.plate, context=context), spots)

    def _in_plate(
        self, plate: PlateCase, mesh: PlateMesh, given: _Plate, spots: Sequence[tuple[Location, _Spot]]
    ) -> Mistakes:
        """Yield what does not fit the plate of a mesh."""
        if isinstance(plate, ShapeCase) and given.cell_size is not None:
            most = plate.measures[0] / 2
            if given.cell_size > most * (1 + SAME_PLACE):
                limit = f"half of the plate's smallest width, {shown_length(most)}"
                yield ("plate", "cell_size"), f"must not exceed {limit}; got {shown_length(given.cell_size)}"
        names = list(mesh.boundaries)
        supports = given.supports if isinstance(given.supports, dict) else {}
        for name in (name for name in supports if name not in names):
            near = difflib.get_close_matches(name, names, 1)
            hint = f"did you mean {near[0]}? " if near else ""
            has = f"It has {', '.join(names)}" if hint else f"it has {', '.join(names)}"
            yield ("plate", "supports", name), f"is no boundary of the plate; {hint}{has}"
        places = {(*table, "position"): spot.position for table, spot in spots if spot.position}
        part = {("part", "position"): self.part.position} if self.part and self.part.position else {}
        size = float((mesh.outline.box[1] - mesh.outline.box[0]).max()) / 2
        for location, place in [*places.items(), *part.items()]:
            gap = float(mesh.outline.gap(place))
            if gap <= SAME_PLACE * size:
                where = f"{shown_length(-gap)} beyond it" if gap < -SAME_PLACE * size else "on it"
                yield location, f"must be inside the rim; got a point {where}"
        shared = set()
        for (one, here), (other, there) in combinations(places.items(), 2):
            if other not in shared and math.dist(here, there) < SAME_PLACE * size:
                shared.add(other)
                yield other, f"must differ from {shown_location(one)}; got the same point"
        held = [spot.position for _, spot in spots if spot.position and spot.force is None]
        if given.supports is not None and len(held) == len(places) - sum(spot.force is not None for _, spot in spots):
            yield from _rigid_motion(plate.model_copy(update={"supports": given.supports}), mesh, held)


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
