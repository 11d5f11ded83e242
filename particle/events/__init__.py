"""The event-located integrator: rest, sliding, flight, and what lies between them."""

from particle.events.breakaway import first_slip, mobility, moved, rest_pull
from particle.events.contact_end import end_reason
from particle.events.contact_state import ContactState, contact_states
from particle.events.dense_output import resume
from particle.events.equations import Part, by_centre, drag, length, margin, of_centre, pull, push
from particle.events.integrator import march
from particle.events.memory import Memory, clear_memory, new_memory
from particle.events.motion import Counts, Motion, Now
from particle.events.parallel import inner, normal_bend
from particle.events.record import ROW, EventRow, PathRecord, Row, fill_row, new_record, note, write
from particle.events.request import Request
from particle.events.slipping import count_slips, find_lost
from particle.events.stay import horizon, stays
from particle.events.stick import ROUNDING
from particle.events.tableau import Pairs, Tableau, pairs_for, tableau
