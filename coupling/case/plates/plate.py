"""The plate of a case: its shape, material and supports, with one model for each shape."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Final, Literal, TypeVar

from pydantic import (
    Discriminator,
    Field,
    StrictBool,
    StrictFloat,
    Tag,
    WrapValidator,
    field_validator,
)

from coupling.case.table import Contradictions, Table
from coupling.case.values import (
    ONE,
    Angle,
    Density,
    Expected,
    Foundation,
    Frequency,
    LoadPressure,
    OneOrList,
    PositiveLength,
    PositivePressure,
    Pressure,
    Tension,
    quoted,
    tag,
)

if TYPE_CHECKING:
    from meshes import PlateMesh

Theory = Literal["linear", "von-karman"]
VON_KARMAN: Final = 'theory = "von-karman"'
INERTIA: Final = "inertia = true"

Wafer = Literal["100", "110", "111"]
SILICON: Final = (165.7e9, 63.9e9, 79.6e9)
"""c11, c12 and c44 [Pa] (Hopcroft, Nix and Kenny, 2010)."""
CONSTANTS: Final = ("c11", "c12", "c44")

_EACH: Final = tag("each")
Name = TypeVar("Name", bound=str)
OneOrEach = Annotated[
    Annotated[Name, Tag(ONE)] | Annotated[dict[str, Name], Tag(_EACH)],
    Discriminator(lambda value: _EACH if isinstance(value, dict) else ONE),
]
Supports = OneOrEach[Literal["clamped", "simply-supported", "free"]]
InPlaneSupports = OneOrEach[Literal["immovable", "movable"]]

_RATIOS: Final = Expected(
    'a ratio from 0 to below 1, or pairs of a frequency and a ratio, such as [["20 kHz", 0.02], ["80 kHz", 0.01]]'
)


def _ratios(value: object, handler: Callable[[object], Any]) -> Any:
    """A damping ratio, or pairs of a frequency and the ratio there."""
    pairs = value if isinstance(value, (list, tuple)) else [[0, value]]
    if not pairs or not all(isinstance(one, (list, tuple)) and len(one) == 2 and _is_ratio(one[1]) for one in pairs):
        raise ValueError(f"must be {_RATIOS.expected}; got {quoted(value)}")
    found = handler(value)
    if isinstance(found, tuple) and any(high <= low for (low, _), (high, _) in pairwise(found)):
        raise ValueError(f"must have increasing frequencies; got {quoted(value)}")
    return found


def _is_ratio(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and 0 <= value < 1


DampingRatios = Annotated[
    OneOrList[StrictFloat, tuple[tuple[Frequency, StrictFloat], ...]], WrapValidator(_ratios), _RATIOS
]


class PlateCase(Table, ABC):
    """The plate, in m, Pa and kg/m^3."""

    outlined_by: ClassVar[str] = "shape"
    """The key at which a mistake in the outline as a whole is reported."""
    in_template: ClassVar[tuple[str, ...]] = ("youngs_modulus", "poisson_ratio")

    supports: Supports = "clamped"
    """The support of the whole rim, or a table with that of each boundary; those left out are free."""
    theory: Theory = "linear"
    """Whether the plate only bends, or also stretches as it deflects."""
    in_plane_supports: InPlaneSupports = "immovable"
    """The in-plane support of boundaries that are not free, or a table with that of each; those left out can move."""
    youngs_modulus: PositivePressure | None = None
    """Young's modulus, of an isotropic plate."""
    poisson_ratio: StrictFloat | None = Field(default=None, ge=0, lt=0.5, examples=[0.3])
    """Poisson's ratio, of an isotropic plate."""
    wafer: Wafer | None = Field(default=None, examples=["100"])
    """The plane in which the plate is cut from a cubic crystal, instead of a Young's modulus and a Poisson's ratio."""
    wafer_angle: Angle = Field(default=0.0, examples=["0 deg"])
    """From x to a direction <110> of the crystal, along which a (100) wafer has its primary flat."""
    c11: PositivePressure = SILICON[0]
    """The crystal's elastic constant c11; that of silicon by default."""
    c12: Pressure = SILICON[1]
    """Its elastic constant c12."""
    c44: PositivePressure = SILICON[2]
    """Its elastic constant c44."""
    thickness: PositiveLength = Field(examples=["5 um"])
    """How thick it is."""
    density: Density | None = None
    """With it drives are compared with the plate's first frequency; `inertia` needs it."""
    inertia: StrictBool = False
    """Whether the plate's mass counts, so that it rings and resonates."""
    damping: DampingRatios = 0.02
    """The damping ratio of its modes, with `inertia`; or pairs of a frequency and the ratio there."""
    tension: Tension = Field(default=0.0, examples=["50 N/m"])
    """A residual force per length in its plane, the same in all directions: positive pulls, negative presses."""
    pressure: LoadPressure = Field(default=0.0, examples=["100 Pa"])
    """A uniform pressure that stays what it is, positive up; actuators keep their strokes and forces."""
    foundation: Foundation = Field(default=0.0, examples=["1e10 N/m^3"])
    """The modulus of an elastic foundation under all of the plate, which pulls back; negative: it softens."""
    top_face: StrictBool = True
    """Whether parts lie on the top face, which bending also moves in its plane, or, if false, on the mid-plane."""

    @field_validator("top_face", "inertia", mode="before")
    @classmethod
    def _from_word(cls, value: Any) -> Any:
        """Sweeps write truth values as words."""
        return {"true": True, "false": False}.get(value, value) if isinstance(value, str) else value

    @classmethod
    def contradictions(cls, given: Mapping[str, Any]) -> Contradictions:
        if "in_plane_supports" in given and given.get("theory", "linear") == "linear":
            yield "in_plane_supports", f"must not be given without {VON_KARMAN}; a linear plate does not stretch"
        yield from _material(given)
        inertia = given.get("inertia", False)
        if inertia and "density" not in given:
            yield "density", f'is missing; with {INERTIA} it must be a density such as "2330 kg/m^3"'
        if "damping" in given and not inertia:
            yield "damping", f"must not be given without {INERTIA}; a plate without mass does not vibrate"

    @abstractmethod
    def build_mesh(self) -> PlateMesh:
        """The plate's mesh; ValueError or OSError where there is none."""

    @cached_property
    def coarse_mesh(self) -> PlateMesh:
        """A mesh that is quickly made, for its outline and its boundaries' names; raises as `build_mesh`."""
        return self.build_mesh()

    @property
    def cell_size_given(self) -> bool:
        """Whether the mesh is to stay as fine as it is."""
        return False

    def supports_of(self, boundaries: list[str]) -> dict[str, str]:
        """The support of each boundary."""
        if isinstance(self.supports, str):
            return dict.fromkeys(boundaries, self.supports)
        return {name: self.supports.get(name, "free") for name in boundaries}


def _material(given: Mapping[str, Any]) -> Contradictions:
    """Yield which keys of the material are missing or too many."""
    isotropic = {"youngs_modulus": 'a pressure such as "169 GPa"', "poisson_ratio": "a number such as 0.3"}
    constants = [given.get(name, value) for name, value in zip(CONSTANTS, SILICON, strict=True)]
    if "wafer" not in given:
        for key, what in isotropic.items():
            if key not in given:
                yield key, f'is missing; it must be {what}, or use a wafer such as "100" instead'
        for key in ("wafer_angle", *CONSTANTS):
            if key in given:
                yield key, "must not be given without a wafer"
        return
    for key in isotropic:
        if key in given:
            yield key, "must not be given with a wafer, whose stiffness follows from its elastic constants"
    if given.get("theory", "linear") == "von-karman":
        yield "wafer", f"must not be given with {VON_KARMAN}, which is for isotropic plates; leave out theory"
    if 0 < sum(name in given for name in CONSTANTS) < len(CONSTANTS):
        for name in CONSTANTS:
            if name not in given:
                yield name, "is missing; a crystal that is not silicon has three constants, pressures such as 128 GPa"
    else:
        c11, c12, _ = constants
        if not (c11 > abs(c12) and c11 + 2 * c12 > 0):
            first = next((name for name in CONSTANTS[:2] if name in given), "wafer")
            yield first, f"must be of a stable crystal, c11 > |c12| and c11 + 2 c12 > 0; got {c11:g} and {c12:g} Pa"
