"""Flight: a part that has come off, up to where it lands, and impacts."""

from particle.events.flight.flight import fly, take_off
from particle.events.flight.impact import MIN_JUMP, cross_jump, velocity_jump
