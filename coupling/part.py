"""The part of a case and its friction law, as the integrator takes them."""

from __future__ import annotations

from functools import lru_cache

from coupling.case import Case, ConstantCase, CoulombCase, FrictionCase, TableCase
from particle import ConstantFriction, CoulombAdhesion, FrictionTable, KogutEtsion, Micropart
from particle.friction import Contact


def build_friction(case: Case) -> Contact:
    """The friction law between part and surface."""
    return friction_law(case.friction)


@lru_cache(maxsize=64)
def friction_law(law: FrictionCase) -> Contact:
    """The friction law of a case's table; one that was made lately is not tabulated again."""
    if isinstance(law, ConstantCase):
        return ConstantFriction(law.limit)
    if isinstance(law, CoulombCase):
        return CoulombAdhesion(law.coefficient, law.adhesion, law.static_coefficient)
    if isinstance(law, TableCase):
        return FrictionTable(law.loads or (), law.limits or (), law.static_ratio)
    return KogutEtsion(**law.model_dump(exclude={"model", "preset"}))


def build_part(case: Case, position: tuple[float, float] | None = None) -> Micropart:
    """The part of a case, at its start or another place [m]."""
    p = case.part
    return Micropart(p.mass, position or p.position, p.velocity, p.squeeze, p.centre_height)
