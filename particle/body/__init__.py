"""A part with a face: a rigid body that slides, turns and tips on the moving surface."""

from particle.body.balance import Balance, least_pressure
from particle.body.body import Body
from particle.body.collocation import AHEAD, AT_START, DIFFERENCE, NODES, ORDER, STAGES, A
from particle.body.contact import face_states
from particle.body.face import Face
from particle.body.limit import Search
from particle.body.march import march_body
from particle.body.memory import Memory as BodyMemory
from particle.body.memory import new_memory as new_body_memory
from particle.body.rest import quick_gauge, rest_margins, rest_responses
