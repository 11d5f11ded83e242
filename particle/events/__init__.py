"""The event-located integrator: rest, sliding, flight, and what lies between them."""

from particle.events.contact_state import CONTACT_STATE, ContactState, contact_states, rest_loads
from particle.events.integrator import FIRST_STEP, march
from particle.events.mechanics import (
    Counts,
    Motion,
    Now,
    Part,
    after_friction,
    at_centre,
    at_contact,
    by_centre,
    drag,
    grip_at,
    inner,
    length,
    margin,
    normal_bend,
    of_centre,
    pull,
    push,
    rest_pull,
)
from particle.events.memory import Memory, clear_memory, new_memory
from particle.events.record import (
    ROW,
    EventRow,
    PathRecord,
    Row,
    fill_row,
    last_row,
    new_record,
    note,
    with_room,
    write,
)
from particle.events.request import Request
from particle.events.rest import ROUNDING
from particle.events.sliding import end_reason
from particle.events.tableau import Pairs, Tableau, pairs_for, tableau
