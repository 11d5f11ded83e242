"""A plate that stretches and has mass: its modes ring while the membrane couples them."""

from coupling.ringing.model import RingingModel, make_ringing_model
