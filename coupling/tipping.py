"""Tipping: how far friction shifts the centre of pressure under a part, over half the part's size."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from coupling.case import Case
from particle import KogutEtsion, Trajectory
from particle.friction import Contact

FloatArray = NDArray[np.float64]

SEPARATIONS = 1001  # of a rough contact, from pull-off to the largest load: linear between them to 1e-4


def tipping_of(case: Case, trajectory: Trajectory, friction: Contact, times: FloatArray) -> float | None:
    """The largest shift of the centre of pressure at times (k,) [s], over half the part's size; None: size not given.

    Friction F on the face below a centre of mass at height h over it has the moment F h. What presses on the face, N +
    adhesion, takes it up by its shift s = F h / (N + adhesion); beyond s = size / 2 the part turns about its edge.
    Adhesion draws on the whole face alike, so it has no moment about its middle.
    """
    if case.footprint is None:
        return None
    if case.part.centre_height == 0:
        return 0.0
    samples = trajectory.contact_at(times)
    pressing = pressing_force(samples.normal_force, friction)
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
    if isinstance(friction, KogutEtsion):
        contact, adhesion, _ = friction.forces(np.linspace(*friction.branch[::-1], SEPARATIONS))
        return np.asarray(np.interp(load, contact - adhesion, contact))
    return load + (friction.pull_off if states_adhesion(friction) else 0.0)
