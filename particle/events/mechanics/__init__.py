"""Mechanics: the equations of motion, on parallel surfaces, and the first moments of sliding."""

from particle.events.mechanics.breakaway import (
    RestPull,
    after_friction,
    first_slip,
    heading,
    manifold_rate,
    mobility,
    moved,
    rest_pull,
    velocity,
)
from particle.events.mechanics.equations import (
    Part,
    Pull,
    at_centre,
    at_contact,
    braked,
    by_centre,
    carried,
    drag,
    energy,
    energy_at_rest,
    grip_at,
    length,
    margin,
    of_centre,
    over_plane,
    pull,
    push,
    rising,
    slide_rate,
    slip,
    slip_speed,
)
from particle.events.mechanics.motion import INTEGRATED, Counts, Motion, Now, as_numbers
from particle.events.mechanics.parallel import (
    inner,
    normal_bend,
    normal_rate,
    shape_operator,
    stretched,
    to_height,
    unstretched,
)
