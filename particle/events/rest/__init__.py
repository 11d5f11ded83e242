"""Rest: what acts on a part at rest, and how long it stays."""

from particle.events.rest.slipping import load_and_demand, rest_over_time
from particle.events.rest.stay import horizon, stays
from particle.events.rest.stick import Rest, leaves_rest, new_rest
from particle.events.rest.stick_level import ROUNDING
