"""Rest: what acts on a part at rest, and how long it stays."""

from particle.events.rest.slipping import rest_loads
from particle.events.rest.stay import horizon
from particle.events.rest.stick import Rest, leaves_rest, new_rest
from particle.events.rest.stick_margin import ROUNDING
