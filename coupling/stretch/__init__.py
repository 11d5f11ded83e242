"""A plate that stretches: its reduced model, kept on disk, and the drives of its corrections over time."""

from coupling.stretch.corrections import Corrections, correction_drives
from coupling.stretch.interval import Moment, add_rows, clear, dot, new_moment
from coupling.stretch.model import StretchModel, equilibrium_at, make_model
from coupling.stretch.newton import FINE, NOT_STABLE, State, find_equilibrium, find_rates, follow_equilibrium, new_state
from coupling.stretch.pieces import lay_piece
from coupling.stretch.response import Response, room_beyond
from coupling.stretch.schedule import Schedule, breakpoints, schedule_of
from coupling.stretch.store import keep_model, key_of, read_model
from coupling.stretch.stretch import Stretch
