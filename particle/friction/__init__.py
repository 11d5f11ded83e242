"""Friction laws: the largest tangential force that a contact transmits under a net normal force."""

from particle.friction.contact import (
    LOCAL,
    ConstantFriction,
    Contact,
    FrictionLaw,
    ScaledFriction,
    friction_limit,
    friction_limits,
    friction_slope,
)
from particle.friction.grip import Grip, grip, pressures, rule_for, spread_of, sums
from particle.friction.kogut_etsion import KogutEtsion
from particle.friction.local import LocalContact
