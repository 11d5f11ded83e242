"""Rest: how long a part at rest stays."""

from particle.events.rest.stick import Rest, leaves_rest, new_rest
from particle.events.rest.stick_margin import ROUNDING
