"""A surface as steep as it stretches: slopes around 0.5 on a base that moves, and a gradient of u of that order."""

import numpy as np

from particle import (
    ConstantFriction,
    CoulombAdhesion,
    TableDrive,
    polynomial_surface,
)
from particle.surface.local import new_local
from particle.surface.span import enter

G = 9.80665
PLACE, VELOCITY, TIME = np.array([0.3, -0.2]), np.array([0.7, -1.1]), 0.4


def steep_surface(strain=0.2):
    """Slopes around 0.5 on a base that moves, with a gradient of u of that order."""
    rng = np.random.default_rng(5)
    base = [TableDrive([0.0, 1.0], [0.0, height]) for height in (0.3, -0.2)]
    c, u = 0.4 * rng.normal(size=(4, 4, 5)), strain * rng.normal(size=(2, 3, 3, 5))
    return polynomial_surface(c, base=base, in_plane=u)


def local_at(surface, place=PLACE, time=TIME):
    local = new_local(surface.record)
    enter(surface.record, local, *place, time, 1.0)
    return local


LAWS = {
    "constant": ConstantFriction(6.0),
    "coulomb": CoulombAdhesion(0.6, 10.0, static_coefficient=0.7),
}
