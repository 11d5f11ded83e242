"""The plate of a case: its shape, material and supports, with one model for each shape."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Final, Literal

from pydantic import (
    Discriminator,
    Field,
    StrictBool,
    StrictFloat,
    Tag,
    field_validator,
)

from coupling.case.plates.damping import DampingRatios
from coupling.case.table import Contradictions, KeyedTable
from coupling.case.values import Density, Length, LoadPressure, Pressure, Tension

if TYPE_CHECKING:
    from meshes import PlateMesh

Theory = Literal["linear", "von-karman"]
VON_KARMAN: Final = 'theory = "von-karman"'
INERTIA: Final = "inertia = true"

SupportName = Literal["clamped", "simply-supported", "free"]
ONE_SUPPORT, SUPPORT_OF_EACH = "one support", "a support of each boundary"
Supports = Annotated[
    Annotated[SupportName, Tag(ONE_SUPPORT)] | Annotated[dict[str, SupportName], Tag(SUPPORT_OF_EACH)],
    Discriminator(lambda value: SUPPORT_OF_EACH if isinstance(value, dict) else ONE_SUPPORT),
]
InPlaneName = Literal["immovable", "movable"]
InPlaneSupports = Annotated[
    Annotated[InPlaneName, Tag(ONE_SUPPORT)] | Annotated[dict[str, InPlaneName], Tag(SUPPORT_OF_EACH)],
    Discriminator(lambda value: SUPPORT_OF_EACH if isinstance(value, dict) else ONE_SUPPORT),
]


class PlateCase(KeyedTable, ABC):
    """The plate, in m, Pa and kg/m^3."""

    outlined_by: ClassVar[str] = "shape"
    """The key at which a mistake in the outline as a whole is reported."""

    supports: Supports = "clamped"
    """How the whole rim is held, or a table with how each boundary is; those left out are free."""
    theory: Theory = "linear"
    """Whether the plate only bends, or also stretches as it deflects."""
    in_plane_supports: InPlaneSupports = "immovable"
    """How boundaries that are not free are held in the plane, or a table with how each is; those left out can move."""
    youngs_modulus: Pressure = Field(gt=0)
    """Young's modulus."""
    poisson_ratio: StrictFloat = Field(ge=0, lt=0.5, examples=[0.3])
    """Poisson's ratio."""
    thickness: Length = Field(gt=0, examples=["5 um"])
    """How thick it is."""
    density: Density | None = Field(default=None, gt=0)
    """With it drives are compared with the plate's first frequency; `inertia` needs it."""
    inertia: StrictBool = False
    """Whether the plate's mass counts, so that it rings and resonates."""
    damping: DampingRatios = 0.02
    """The damping ratio of its modes, with `inertia`; or pairs of a frequency and the ratio there."""
    tension: Tension = Field(default=0.0, examples=["50 N/m"])
    """A residual force per length in its plane, the same in all directions: positive pulls, negative presses."""
    pressure: LoadPressure = Field(default=0.0, examples=["100 Pa"])
    """A uniform pressure that stays what it is, positive up; actuators keep their strokes and forces."""
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
        inertia = given.get("inertia", False)
        if inertia is True and "density" not in given:
            yield "density", f'is missing; with {INERTIA} it must be a density such as "2330 kg/m^3"'
        if "damping" in given and inertia is False:
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
