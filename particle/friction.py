"""Friction laws: the largest tangential force Q that a contact under the net normal force N transmits."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from particle.jit import jit

FloatArray = NDArray[np.float64]

CONSTANT, COULOMB, TABLE = 0, 1, 2


class FrictionLaw(NamedTuple):
    """A friction law as kernels read it."""

    kind: int
    limit: float  # CONSTANT: N
    coefficient: float  # COULOMB: kinetic
    static_ratio: float  # limit of a part that is stuck over that of one that slides
    adhesion: float  # COULOMB: N
    pull_off: float  # N
    largest_load: float  # N, above which the law says nothing
    impact_coefficient: float  # limit of Q(N) / N under large loads, which acts at impacts
    step: float  # TABLE: width of a knot interval in u = ln(1 + sqrt((N + pull_off) / pull_off))
    cubics: FloatArray  # TABLE: (4, knots - 1), of ln(Q / N) on each interval, highest power first


class Contact(Protocol):
    """What `simulate` asks of a friction law."""

    @property
    def law(self) -> FrictionLaw: ...

    @property
    def table_error(self) -> float: ...


@jit
def friction_limit(law: FrictionLaw, load: float) -> float:
    """Q [N] while sliding under the net normal force `load` [N]; 0 at and below -pull_off."""
    if law.kind == CONSTANT:
        return law.limit
    if law.kind == COULOMB:
        return max(0.0, law.coefficient * (load + law.adhesion))
    above = max(0.0, (load + law.pull_off) / law.pull_off)
    place = math.log1p(math.sqrt(above)) / law.step
    knot = min(int(place), law.cubics.shape[1] - 1)
    s = (place - knot) * law.step
    c = law.cubics[:, knot]
    return math.exp(((c[0] * s + c[1]) * s + c[2]) * s + c[3])


def _law(kind: int, pull_off: float, **fields: float) -> FrictionLaw:
    values = {"limit": 0.0, "coefficient": 0.0, "static_ratio": 1.0, "adhesion": 0.0} | fields
    return FrictionLaw(
        kind,
        **values,
        pull_off=pull_off,
        largest_load=math.inf,
        impact_coefficient=values["coefficient"],
        step=1.0,
        cubics=np.zeros((4, 1)),
    )


@dataclass(frozen=True)
class ConstantFriction:
    """Q = limit whatever the load; the part never comes off.

    Raises ValueError when the limit is negative.
    """

    limit: float  # N

    def __post_init__(self) -> None:
        _require(0 <= self.limit < math.inf, "limit", "ConstantFriction", "0 or a positive force in N", self.limit)

    table_error = 0.0

    @property
    def pull_off(self) -> float:
        return math.inf

    @property
    def law(self) -> FrictionLaw:
        return _law(CONSTANT, math.inf, limit=self.limit)


@dataclass(frozen=True)
class CoulombAdhesion:
    """Q = max(0, coefficient (N + adhesion)), the part comes off below N = -adhesion.

    static_coefficient, at least the (kinetic) coefficient, holds a part that is stuck.
    Raises ValueError, naming the field that is wrong.
    """

    coefficient: float
    adhesion: float = 0.0  # N
    static_coefficient: float | None = None

    def __post_init__(self) -> None:
        _require(0 <= self.coefficient < math.inf, "coefficient", "CoulombAdhesion", "0 or positive", self.coefficient)
        _require(
            0 <= self.adhesion < math.inf, "adhesion", "CoulombAdhesion", "0 or a positive force in N", self.adhesion
        )
        static = self.static_coefficient
        if static is not None:
            at_least = f"at least the coefficient {self.coefficient!r}, which must then be positive"
            good = static >= self.coefficient > 0
            _require(good, "static_coefficient", "CoulombAdhesion", at_least, static)

    table_error = 0.0

    @property
    def pull_off(self) -> float:
        return self.adhesion

    @property
    def law(self) -> FrictionLaw:
        static = self.coefficient if self.static_coefficient is None else self.static_coefficient
        ratio = static / self.coefficient if self.coefficient > 0 else 1.0
        return _law(COULOMB, self.adhesion, coefficient=self.coefficient, static_ratio=ratio, adhesion=self.adhesion)


def _require(good: bool, name: str, owner: str, right: str, got: object) -> None:
    if not good:
        raise ValueError(f"Input {name} of {owner} must be {right}; got {got!r}")
