"""Friction laws: the largest tangential force that a contact transmits under a net normal force."""

from particle.friction.contact import Contact, FrictionLaw, friction_limit
from particle.friction.scaled import ScaledFriction
