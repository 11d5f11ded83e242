"""The event-located integrator: rest, sliding, flight, and what lies between them."""

from particle.events import record
from particle.events.breakaway import slope
from particle.events.dense_output import resume
from particle.events.equations import Part, drag, length, margin, pull, push
from particle.events.integrator import Memory, forget, march, new_memory
from particle.events.record import (
    COLUMNS,
    DISSIPATED,
    ENDS,
    FRICTION,
    LOAD,
    MODE,
    RESTING,
    REVERSES,
    SLIDING,
    SLIPS,
    STOPS,
    TIME,
    V_X,
    V_Y,
    WORK,
    Record,
    X,
    Y,
    new_record,
    note,
    row_of,
    write,
)
from particle.events.runge_kutta import Pairs, pairs_for
from particle.events.slide import (
    DETACHED,
    GOES_ON,
    INTERRUPTED,
    LACKS_CELL,
    LEFT_PLATE,
    OVERLOADED,
    WORK_LIMIT,
    Request,
    reason,
)
from particle.events.slipping import count_slips, find_lost
from particle.events.stay import horizon, stays
from particle.events.stick import ROUNDING
