"""Points of a study that cannot be run: how many mistakes they have, and what these are."""

from __future__ import annotations

from functools import lru_cache

from active_surface.arrays import FloatArray
from active_surface.studies.study import Study
from active_surface.studies.variants import case_at
from coupling import friction_law
from coupling.case import (
    Case,
    FrictionCase,
    InputError,
    PlateCase,
    gaps,
    must_be_inside,
)
from particle.friction import Contact

LAWS = 256  # kept


def refusals(study: Study, k: int) -> list[str]:
    """What is wrong with path k of a study; nothing: it can be run."""
    (values,) = study.points.values([k])
    try:
        case = case_at(study, values)
    except InputError as error:
        return mistakes_of(error)
    start = study.points.displacements([k])[0] + case.part.position
    return start_faults(case, start[None])[0] + case_faults(case)


def case_faults(case: Case) -> list[str]:
    """What is wrong with the friction law of a case, whose tables are right."""
    law = contact_of(case.friction)
    return [law] if isinstance(law, str) else []


def mistakes_of(error: InputError) -> list[str]:
    """What is wrong with a case."""
    return [f"{field} {message}" for field, message in error.problems]


@lru_cache(LAWS)
def contact_of(friction: FrictionCase) -> Contact | str:
    """The friction law of a case's table, or what is wrong with it."""
    try:
        law = friction_law(friction)
        law.law  # noqa: B018  # made when it is first asked for
    except (ValueError, ArithmeticError) as error:
        return str(error)
    return law


def start_faults(case: Case, starts: FloatArray) -> list[list[str]]:
    """For each start (n, 2) [m] what is wrong with it, nothing where it is on the plate."""
    if not isinstance(case.plate, PlateCase):
        return [[] for _ in starts]
    mesh = case.plate.coarse_mesh
    return [
        [] if gap > mesh.least_gap else [f"part.position {must_be_inside(gap, mesh)}"]
        for gap in gaps(mesh, [(x, y) for x, y in starts.tolist()])
    ]
