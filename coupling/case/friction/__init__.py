"""Friction: which law, and its parameters or measured points."""

from coupling.case.friction.laws import (
    AnyFriction,
    ConstantCase,
    CoulombCase,
    FrictionCase,
    KogutEtsionCase,
    TableCase,
    has_known_law,
)
from coupling.case.friction.points import Points, read_points
