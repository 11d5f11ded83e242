"""A friction law with all its limits scaled."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from particle.checks import positive, refuse
from particle.friction.contact import TABLE, Contact, FrictionLaw, friction_limits

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class ScaledFriction:
    """A law all of whose limits are `factor` times as high, and whose pull-off force is the same.

    Raises ValueError when the factor is not positive.
    """

    contact: Contact
    factor: float

    def __post_init__(self) -> None:
        refuse("ScaledFriction", [(positive(self.factor), "factor", "positive", self.factor)])

    @property
    def pull_off(self) -> float:
        return self.contact.pull_off

    @property
    def largest_load(self) -> float:
        return self.contact.largest_load

    @property
    def table_error(self) -> float:
        return self.contact.table_error

    @cached_property
    def law(self) -> FrictionLaw:
        law, factor = self.contact.law, self.factor
        pieces = law.pieces * factor
        if law.kind == TABLE:
            pieces = law.pieces + math.log(factor) * np.eye(len(law.pieces))[:, -1:]
        return law._replace(
            limit=law.limit * factor,
            coefficient=law.coefficient * factor,
            impact_coefficient=law.impact_coefficient * factor,
            pieces=pieces,
        )

    def friction_limit(self, net_load: ArrayLike) -> FloatArray:
        """Q [N] under net loads [N] of any shape; ValueError for one outside the law."""
        return friction_limits(self.law, net_load)
