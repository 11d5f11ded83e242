"""A part with a face: a rigid body that slides, turns and tips on the moving surface."""

from particle.body.averages import enter_all, within_cells
from particle.body.balance import Balance, energy_of, find_rates, friction_wrench, least_pressure, powers, solve
from particle.body.body import Body
from particle.body.collocation import AHEAD, AT_START, DIFFERENCE, NODES, ORDER, STAGES, A
from particle.body.contact import face_states
from particle.body.face import Face
from particle.body.limit import Search, gauge, needed, slip_rate
from particle.body.march import jumps, keep_carried, march_body
from particle.body.memory import Memory as BodyMemory
from particle.body.memory import new_memory as new_body_memory
from particle.body.rest import quick_gauge, rest_margins, rest_responses
from particle.body.state import base_at, rim_margin, slip_speed
from particle.body.state import settle as settle_body
