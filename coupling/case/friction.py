"""The `[friction]` table of a case file: which law, and its parameters or measured points."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, ClassVar, Final, Literal, Self

from pydantic import BeforeValidator, Discriminator, Field, StrictFloat, Tag

from coupling.case.table import Contradictions, Faults, Table, named
from coupling.case.values import (
    FileBeside,
    Force,
    Listed,
    PositiveArea,
    PositiveLength,
    PositivePressure,
    Quantity,
    SurfaceEnergy,
    by_line,
    read_columns,
    tag,
    unreadable,
)
from particle import PAPER_PLASTICITY_INDEX, point_mistakes
from particle import KogutEtsionInput as Default

_SEVERAL: Final = Listed('a list of forces such as ["-1 uN", "0 N", "5 uN"]')


def _plasticity_index(data: dict[str, Any]) -> float:
    return PAPER_PLASTICITY_INDEX if data.get("preset") == "paper" else Default.plasticity_index


class KogutEtsionCase(Table):
    """Friction of rough surfaces with adhesion, after Kogut and Etsion, in m, m^2, Pa and J/m^2."""

    model: Literal["kogut-etsion"] = "kogut-etsion"
    """The law: rough surfaces with adhesion, after Kogut and Etsion."""
    preset: Literal["paper"] | None = None
    """All parameters as the paper has them, the plasticity index 4.9128 among them."""
    roughness: PositiveLength = Default.roughness
    """The standard deviation of the heights of asperities."""
    contact_area: PositiveArea = Default.contact_area
    """The nominal area of contact, the footprint of the part."""
    hardness: PositivePressure = Default.hardness
    """The hardness of the softer material."""
    poisson_ratio: StrictFloat = Field(default=Default.poisson_ratio, ge=0, lt=0.5)
    """Poisson's ratio of the softer material."""
    adhesion_energy: SurfaceEnergy = Default.adhesion_energy
    """The work of adhesion of the two surfaces."""
    plasticity_index: StrictFloat = Field(default_factory=_plasticity_index, ge=0.001, le=1000, examples=[2.5])
    """How far asperities yield: well below 1 they are elastic, well above plastic. Without it 2.5."""
    # The model takes the root of 1 - 3.717e-4 / asperity_beta^2.
    asperity_beta: StrictFloat = Field(default=Default.asperity_beta, gt=math.sqrt(3.717e-4), le=1000)
    """Density of asperities times their radius times the roughness."""
    intermolecular_distance: PositiveLength = Default.intermolecular_distance
    """The distance of atoms in equilibrium."""
    coefficients: Literal["printed", "unrounded"] = "printed"
    """Numbers of the model as its authors printed them, or without their rounding."""

    @classmethod
    def contradictions(cls, given: Mapping[str, Any]) -> Contradictions:
        if given.get("preset") != "paper":
            return
        if "plasticity_index" in given:
            yield (
                "plasticity_index",
                f'must not be given with preset = "paper", which sets it to {PAPER_PLASTICITY_INDEX}',
            )
        if given.get("coefficients", "printed") != "printed":
            only = f'which is for those coefficients only; got "{given["coefficients"]}"'
            yield "coefficients", f'must be "printed" with preset = "paper", {only}'


class ConstantCase(Table):
    """A friction force of at most `limit`, in N, whatever the normal force."""

    model: Literal["constant"] = "constant"
    """The law: a limit that does not depend on the load."""
    limit: Force = Field(ge=0, examples=["40 nN"])
    """The largest friction force."""


class CoulombCase(Table):
    """Friction in proportion to the normal force and `adhesion`, in N; `static_coefficient` is for a part at rest."""

    model: Literal["coulomb"] = "coulomb"
    """The law: in proportion to the load, with adhesion added to it."""
    coefficient: StrictFloat = Field(ge=0, le=1e6, examples=[0.3])
    """Friction force over load while the part slides."""
    adhesion: Force = Field(default=0.0, ge=0)
    """A force added to the load; the part comes off where it is pulled harder."""
    static_coefficient: StrictFloat | None = Field(default=None, ge=0, le=1e6, examples=[0.4])
    """Friction force over load while the part rests; without it as while it slides."""

    @classmethod
    def contradictions(cls, given: Mapping[str, Any]) -> Contradictions:
        sliding, static = given["coefficient"], given.get("static_coefficient")
        if static is None:
            return
        if static < sliding:
            yield "static_coefficient", f"must be at least coefficient, {sliding:g}; got {static:g}"
        elif sliding == 0:
            yield "static_coefficient", f"must not be given with coefficient = 0; got {static:g}"


Forces = Annotated[tuple[Force, ...], _SEVERAL]


class TableCase(Table):
    """Friction measured at points: `limits` over the net `loads`, in N; `file` has both instead.

    The file is read when a case is made, which then has its points and no `file`.
    """

    in_template: ClassVar[tuple[str, ...]] = ("loads", "limits")

    model: Literal["table"] = "table"
    """The law: as measured at points."""
    loads: Forces | None = Field(default=None, examples=[["-1 uN", "0 uN", "2 uN", "5 uN"]])
    """Net loads, increasing; the first is minus the pull-off force."""
    limits: Forces | None = Field(default=None, examples=[["4 nN", "18 nN", "35 nN", "52 nN"]])
    """The largest friction force at each load; it does not fall."""
    static_ratio: StrictFloat = Field(default=1.0, ge=1, le=1e6)
    """The limit at rest over that of sliding."""
    file: FileBeside | None = Field(default=None, examples=["friction.csv"])
    """A CSV file with a column of each, instead of the two lists, beside the case file."""

    @classmethod
    def contradictions(cls, given: Mapping[str, Any]) -> Contradictions:
        if "file" in given:
            for name in (name for name in ("loads", "limits") if name in given):
                yield name, "must not be given with a file, which has the points"
        elif "loads" not in given:
            yield "loads", f'is missing; it must be {_SEVERAL.expected}, or use file = "friction.csv" instead'
        elif "limits" not in given:
            yield "limits", "is missing; it must be as many forces as the loads"
        else:
            for name, point, message in point_mistakes(given["loads"], given["limits"]):
                yield name if point is None else (name, point), message

    def with_points(self) -> Self:
        """The law with the points of its file, if it has one; raises Faults with what is wrong there, by lines."""
        if self.file is None:
            return self
        path, force = Path(self.file), Quantity("N", "2 uN")
        try:
            known = {"load": force, "limit": force}
            read = read_columns(path, known, [["load"], ["limit"]], "load [uN], limit [nN]", exact=True)
            wrong = [f"in {path.name}: {message}" for message in read.mistakes]
        except (OSError, ValueError) as error:
            wrong = [unreadable(path.name, error)]
        if not wrong:
            loads, limits = read.columns["load"], read.columns["limit"]
            faults = list(point_mistakes(loads, limits))
            wrong = [f"in {path.name}: has too few points; {one} {text}" for one, at, text in faults if at is None]
            lined = [(read.lines[at], f"{one[:-1]} {text}") for one, at, text in faults if at is not None]
            wrong = wrong or [f"in {path.name}: {message}" for message in by_line(lined)]
        if wrong:
            raise Faults((("friction", "file"), message) for message in wrong)
        return self.model_copy(update={"loads": loads, "limits": limits, "file": None})


def has_known_law(friction: FrictionCase) -> bool:
    """Whether a valid table certainly has a friction law; of Kogut and Etsion's only those with default numbers."""
    if not isinstance(friction, KogutEtsionCase):
        return True
    return friction == KogutEtsionCase(preset=friction.preset)


_LAWS: Final = {"kogut-etsion": KogutEtsionCase, "constant": ConstantCase, "coulomb": CoulombCase, "table": TableCase}


def _law(friction: Any) -> str:
    return tag(friction["model"] if isinstance(friction, Mapping) else getattr(friction, "model", "constant"))


FrictionCase = KogutEtsionCase | ConstantCase | CoulombCase | TableCase
AnyFriction = Annotated[
    Annotated[KogutEtsionCase, Tag(tag("kogut-etsion"))]
    | Annotated[ConstantCase, Tag(tag("constant"))]
    | Annotated[CoulombCase, Tag(tag("coulomb"))]
    | Annotated[TableCase, Tag(tag("table"))],
    Discriminator(_law),
    BeforeValidator(named("model", _LAWS)),
]
