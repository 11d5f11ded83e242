"""Sliding: its steps, the slow manifold, the stop, and where contact ends."""

from particle.events.sliding.contact_end import end_reason
from particle.events.sliding.manifold import first_mode
from particle.events.sliding.slide import MIN_STEP, bridge, slide
from particle.events.sliding.stop import Stop, frozen_stop
