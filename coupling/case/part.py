"""The `[part]` and `[[parts]]` tables of a case file: points, or bodies with a face that turns."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Final, Literal

from pydantic import Field, StrictStr

from coupling.case.table import Contradictions, Table
from coupling.case.values import (
    Angle,
    AngularVelocity,
    Density,
    Force,
    Length,
    Listed,
    Mass,
    Point,
    PositiveLength,
    Velocity,
    expected_of,
)

if TYPE_CHECKING:
    from particle import Footprint

OUTLINES: Final = {"rectangle": "sides", "disc": "radius", "polygon": "corners"}
"""The key with the size of each footprint."""
_CORNERS: Final = "three or more corners, in order around the part, whose sides do not cross"


def _footprint(data: Mapping[str, Any]) -> Footprint | None:
    """The footprint of keys that are right each by itself; None: a point, or a size is missing or wrong."""
    size = data.get(OUTLINES.get(data.get("footprint") or "", ""))
    if size is None:
        return None
    from particle import Footprint  # here, because it loads numpy

    try:
        if data["footprint"] == "rectangle":
            return Footprint.rectangle(*size)
        return Footprint.disc(size) if data["footprint"] == "disc" else Footprint.polygon(size)
    except ValueError:
        return None


def _mass(data: dict[str, Any]) -> float:
    """The mass of a block of that density; nan where it does not follow."""
    face, density, thickness = _footprint(data), data.get("density"), data.get("thickness")
    return density * face.area * thickness if face and density and thickness else math.nan


def _middle(data: dict[str, Any]) -> float:
    """Half the thickness; of a point 0."""
    return (data.get("thickness") or 0.0) / 2


class PartCase(Table):
    """The part at the start, in kg, m, m/s and N: a point, or with a footprint a rigid body with a face that turns."""

    in_template: ClassVar[tuple[str, ...]] = ("mass",)

    footprint: Literal["rectangle", "disc", "polygon"] | None = None
    """The outline of its face, flat on the surface; without it the part is a point, which does not turn."""
    sides: Annotated[tuple[PositiveLength, PositiveLength], Listed("two lengths, along its x and y", 2, 2)] | None = (
        Field(default=None, examples=[["100 um", "100 um"]])
    )
    """The sides of a rectangle, along its own x and y."""
    radius: PositiveLength | None = Field(default=None, examples=["50 um"])
    """The radius of a disc."""
    corners: Annotated[tuple[Point, ...], Listed(_CORNERS, 3)] | None = Field(
        default=None, examples=[[["-50 um", "-50 um"], ["50 um", "-50 um"], ["0 um", "50 um"]]]
    )
    """The corners of a polygon, three or more, in order; it may turn inwards, and is moved to its centroid."""
    thickness: PositiveLength | None = Field(default=None, examples=["50 um"])
    """How thick a part with a footprint is."""
    density: Density | None = None
    """Its density, in place of its mass."""
    mass: Mass = Field(default_factory=_mass)
    """Its mass."""
    position: Point = Field(examples=[["100 um", "50 um"]])
    """Where it is at the start, with a footprint its centroid; on the plate, or counted from the platform."""
    heading: Angle = Field(default=0.0, examples=["30 deg"])
    """How far it is turned at the start, counter-clockwise, its x against that of the plate."""
    velocity: Velocity = (0.0, 0.0)
    """How fast it moves at the start, over the platform if there is one."""
    spin: AngularVelocity = 0.0
    """How fast it turns at the start."""
    size: PositiveLength | None = Field(default=None, examples=["100 um"])
    """The side of a point's footprint, for checks and its local contact; without it the root of the contact area."""
    local_contact: bool = False
    """Whether a rough contact follows its law point by point on the bent surface under the footprint or that square."""
    squeeze: Force = Field(default=0.0, ge=0)
    """A constant force that presses it onto the surface, along the normal."""
    centre_height: Length = Field(default_factory=_middle, ge=0, examples=["50 um"])
    """How high its centre of mass stands above the surface that it lies on; without it half the thickness."""
    pressure: Literal["linear", "uniform"] = "linear"
    """Under the footprint: linear, so that it bears the moments on the part, or the same everywhere."""

    @classmethod
    def contradictions(cls, given: Mapping[str, Any]) -> Contradictions:
        kind, stated = given.get("footprint"), not math.isnan(given.get("mass", math.nan))
        expected = {key: expected_of(cls.model_fields[key]) for key in ("mass", "thickness", *OUTLINES.values())}
        if kind is None:
            for key in (*OUTLINES.values(), "thickness", "density", "heading", "spin", "pressure"):
                if key in given:
                    yield key, 'must not be given without a footprint, such as footprint = "rectangle"'
            if not stated:
                yield "mass", f"is missing; it must be {expected['mass']}"
            return
        for other, key in OUTLINES.items():
            if other == kind and key not in given:
                yield key, f'is missing; with footprint = "{kind}" it must be {expected[key]}'
            elif other != kind and key in given:
                yield key, f'must not be given with footprint = "{kind}", which has {OUTLINES[kind]}'
        if kind == "polygon" and "corners" in given and _footprint(given) is None:
            yield "corners", f"must be {_CORNERS}"
        if "thickness" not in given:
            yield "thickness", f"is missing; with a footprint it must be {expected['thickness']}"
        if given.get("local_contact") and given.get("pressure") == "uniform":
            yield "pressure", 'must be "linear" with local_contact = true, which has a pressure of its own'
        if "size" in given:
            yield "size", f"must not be given with a footprint, which has {OUTLINES[kind]}"
        same = "density" in given and stated and math.isclose(given["mass"], _mass(dict(given)), rel_tol=1e-9)
        if "density" in given and stated and not same:  # the same where a case is read back from its results
            yield "density", "must not be given with mass, which follows from it"
        elif "density" not in given and not stated:
            yield "mass", f"is missing; it must be {expected['mass']}, or give density instead"

    @cached_property
    def face(self) -> Footprint | None:
        """Its footprint, from the centroid; None: it is a point."""
        return _footprint(vars(self))

    @property
    def gyration(self) -> float:
        """The radius of gyration of its face about the centroid [m], by which angles count as lengths; of a point 0."""
        return 0.0 if self.face is None else math.sqrt(float(self.face.second_moments.trace()))


PART_NAME: Final = r"^[\w-]{1,40}$"


class NamedPart(PartCase):
    """One of many parts, none of which feels the others."""

    name: StrictStr | None = Field(default=None, pattern=PART_NAME, examples=["left"])
    """The name of one of many parts, also in the names of its files; without it its number."""

    def named(self, number: int) -> str:
        """Its name, or else its number."""
        return self.name or str(number)

    @property
    def alone(self) -> PartCase:
        """The same without its name."""
        return PartCase.model_construct(**{key: value for key, value in self if key != "name"})


UNUSED: Final = PartCase(mass=1.0, position=(0.0, 0.0))
"""Stands for [part] where there are [[parts]]."""
