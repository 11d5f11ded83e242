"""The part of a case and its friction law, as the integrator takes them, and how far a path leaves a point part."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from coupling.case import AirCase, Case, ConstantCase, CoulombCase, FrictionCase, KogutEtsionCase, TableCase
from particle import (
    Air,
    Body,
    ConstantFriction,
    ContactSamples,
    CoulombAdhesion,
    Film,
    Footprint,
    FrictionTable,
    KogutEtsion,
    LocalContact,
    Micropart,
    SurfaceMotion,
    Trajectory,
    assumed_contact,
)
from particle.friction import Contact

if TYPE_CHECKING:
    from meshes import Outline

FloatArray = NDArray[np.float64]

RESTS = 0.999  # of the range of loads of a rough contact, to which the part's weight is cut
SEPARATIONS = 1001  # of a rough contact, from pull-off to the largest load: linear between them to 1e-4
FLAT, MAX_SAG = 0.3, 100.0  # roughnesses: where the bent contact is found
STEEP = 40.0  # roughnesses, up to which a local contact is exact to 1e-4
BLOCK = 50_000  # rows of a path whose curvatures are found together: 20 MB


def build_friction(case: Case) -> Contact:
    """The friction law between part and surface."""
    return friction_law(friction_of(case), local_size(case))


def friction_of(case: Case) -> FrictionCase:
    """The friction table of a case, a rough contact's with the area of the part's face."""
    law, face = case.friction, case.part.face
    if isinstance(law, KogutEtsionCase) and face is not None:
        return law.model_copy(update={"contact_area": face.area})
    return law


def local_size(case: Case) -> float | Footprint | None:
    """The face, or the side [m] of a point's, under which the law of a rough contact is local; None: it is not."""
    return (case.part.face or case.footprint) if case.part.local_contact else None


@lru_cache(maxsize=256)
def friction_law(law: FrictionCase, size: float | Footprint | None = None) -> Contact:
    """The friction law of a case's table; one that was made lately is not tabulated again.

    size: as `local_size`.
    """
    if isinstance(law, ConstantCase):
        return ConstantFriction(law.limit)
    if isinstance(law, CoulombCase):
        return CoulombAdhesion(law.coefficient, law.adhesion, law.static_coefficient)
    if isinstance(law, TableCase):
        return FrictionTable(law.loads or (), law.limits or (), law.static_ratio)
    rough = KogutEtsion(**law.model_dump(exclude={"model", "preset"}))
    return rough if size is None else LocalContact(rough, size)


def footprint_of(case: Case) -> Footprint | None:
    """The part's face, or the square that stands for a point with a size; None: it has none."""
    if case.part.face is not None or case.footprint is None:
        return case.part.face
    return Footprint.rectangle(case.footprint, case.footprint)


def rough_under(case: Case, footprint: Footprint) -> KogutEtsion:
    """The rough contact whose separation is the gap under the part: that of the case, or an assumed one."""
    law = friction_law(friction_of(case))
    return law if isinstance(law, KogutEtsion) else assumed_contact(law, footprint.area)


@lru_cache(maxsize=256)
def resting_separation(rough: KogutEtsion, load: float) -> float:
    """The separation [roughnesses] of a rough contact under a load [N], or where its law ends."""
    return float(rough.separation(min(max(load, -RESTS * rough.pull_off), RESTS * rough.largest_load)))


def weight_of(case: Case) -> float:
    """What presses a part at rest on a level surface [N]."""
    gravity = case.run.gravity
    return case.part.mass * (-gravity[2] if isinstance(gravity, tuple) else gravity) + case.part.squeeze


def air_of(case: Case) -> Air:
    """The air around the part; where a case says nothing of it, that of a room."""
    return Air(**(case.air or AirCase()).model_dump(exclude={"film"}))


def film_of(case: Case) -> Film | None:
    """The film of air under a point; None: the path has none, or the part has a face."""
    if case.air is None or not case.air.film or case.part.face is not None:
        return None
    assert case.footprint is not None
    return Film(air_of(case), case.footprint)


def gap_under(case: Case, footprint: Footprint) -> float:
    """The gap [m] under a part at rest."""
    rough = rough_under(case, footprint)
    return float(rough.mean_gap(resting_separation(rough, weight_of(case)))) + air_of(case).bow


def drag_of(case: Case) -> float:
    """The drag [N s/m] of the air under the part; 0 where a case says nothing of it, or a film has its own."""
    footprint = footprint_of(case)
    if case.air is None or case.air.film or case.air.pressure == 0 or footprint is None:
        return 0.0
    return air_of(case).drag(footprint.area, gap_under(case, footprint))


def build_part(case: Case, position: tuple[float, float] | None = None) -> Micropart | Body:
    """The part of a case, at its start or another place [m]."""
    p, place = case.part, position or case.part.position
    if p.face is not None:
        assert p.thickness is not None
        return Body(
            p.face,
            p.thickness,
            p.mass,
            position=place,
            heading=p.heading,
            velocity=p.velocity,
            spin=p.spin,
            squeeze=p.squeeze,
            centre_height=p.centre_height,
            pressure=p.pressure,
            drag=drag_of(case),
            film=air_of(case) if case.air is not None and case.air.film else None,
        )
    return build_point(case, place)


def build_point(case: Case, position: tuple[float, float] | None = None) -> Micropart:
    """The same of a part without a footprint; raises ValueError for one that has one."""
    p, place = case.part, position or case.part.position
    if p.face is not None:
        raise ValueError("part.footprint must not be given here, where parts are points")
    return Micropart(p.mass, place, p.velocity, p.squeeze, p.centre_height, drag_of(case), film_of(case))


def tipping_of(case: Case, samples: ContactSamples, friction: Contact) -> float | None:
    """The largest shift of the centre of pressure over half the part's size, at some moments.

    None: a point's size is not given, a face has its own pressure, or a film of air bears load.

    Friction F on the face below a centre of mass at height h over it has the moment F h. What presses on the face, N +
    adhesion, takes it up by its shift s = F h / (N + adhesion); beyond s = size / 2 the part turns about its edge.
    Adhesion draws on the whole face alike, so it has no moment about its middle.
    """
    if case.footprint is None or case.part.face is not None or film_of(case) is not None:
        return None
    if case.part.centre_height == 0:
        return 0.0
    pressing = pressing_force(samples.normal_force - samples.bend_loss, friction)
    touching = pressing > 0  # neither in flight nor at pull-off, where friction ends as well
    forces = np.linalg.norm(samples.friction[touching], axis=1)
    shift = case.part.centre_height * forces / pressing[touching]
    return float(shift.max(initial=0.0)) / (case.footprint / 2)


def states_adhesion(friction: Contact) -> bool:
    """Whether a friction law states the adhesion, also of 0; a constant limit holds under any pull."""
    return friction.pull_off < math.inf


def pressing_force(load: FloatArray, friction: Contact) -> FloatArray:
    """What presses the part's face on the plate, load + adhesion [N], under net loads (k,) [N].

    The adhesion is that of the separation in a rough contact, the pull-off force in other laws, and 0 with a constant
    limit, which states none.
    """
    rough = friction.flat if isinstance(friction, LocalContact) else friction
    if isinstance(rough, KogutEtsion):
        contact, adhesion, _ = rough.forces(np.linspace(*rough.branch[::-1], SEPARATIONS))
        return np.asarray(np.interp(load, contact - adhesion, contact))
    return load + (friction.pull_off if states_adhesion(friction) else 0.0)


class Bent(NamedTuple):
    """How a plate is bent under a part where it is bent most along the path."""

    curvature: float  # of the part's size: size times the largest curvature, in any direction
    sag: float | None  # over the roughness of a rough contact; None: another law
    friction: float | None  # at zero load, of contact only where the surfaces meet, over that of a flat face
    pull_off: float | None  # likewise; None: flat enough, or it touches at a few asperities


def bent_under(case: Case, outline: Outline, surface: SurfaceMotion, trajectory: Trajectory) -> Bent | None:
    """How the plate is bent under the part at the rows of its path; None: the part's size is not given."""
    size = case.footprint
    if size is None:
        return None
    on_plate = outline.gap(trajectory.position) >= 0  # all but the last of a part that slid over the rim
    places, times = trajectory.position[on_plate], trajectory.time[on_plate]
    headings = np.zeros(len(trajectory.time)) if trajectory.heading is None else trajectory.heading
    worst, curvature, heading = np.zeros((2, 2)), -1.0, 0.0
    for start in range(0, len(times), BLOCK):
        hessians = surface.evaluate_along(places[start : start + BLOCK], times[start : start + BLOCK]).hessian
        sizes = np.abs(np.linalg.eigvalsh(hessians)).max(axis=1)
        if sizes.max() > curvature:
            worst, curvature = hessians[sizes.argmax()], float(sizes.max())
            heading = float(headings[on_plate][start + sizes.argmax()])
    if not isinstance(law := friction_of(case), KogutEtsionCase):
        return Bent(size * curvature, None, None, None)
    face = case.part.face or Footprint.rectangle(size, size)
    sag = 0.5 * curvature * face.reach**2 / law.roughness
    if not FLAT < sag <= MAX_SAG:
        return Bent(size * curvature, sag, None, None)
    rough = friction_law(law)
    assert isinstance(rough, KogutEtsion)
    turn = np.array([[math.cos(heading), -math.sin(heading)], [math.sin(heading), math.cos(heading)]])
    flat, bent = rough.on_face(face), rough.on_face(face, turn.T @ worst @ turn)
    ratio = float(bent.friction_limit(0.0)) / float(flat.friction_limit(0.0))
    return Bent(size * curvature, sag, ratio, bent.pull_off / flat.pull_off)


def top_face_share(contact: ContactSamples) -> float | None:
    """What the heights of contact and centre of mass add to the pull, over that on a point of the mid-plane.

    Root mean squares over the path, of the vectors' lengths; None where the rest is 0.
    """
    rest, added = (float(np.sqrt(np.nanmean(np.square(pull)))) for pull in (contact.point_pull, contact.added_pull))
    return added / rest if rest > 0 else None
