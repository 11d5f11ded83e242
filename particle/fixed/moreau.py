"""One step of Moreau's time stepping for a part with friction: the velocity, projected.

With everything of the surface in the middle of the step, M = I + grad w grad w^T (the metric of lengths along the
surface) and the pull p of `particle.events.mechanics.equations`, the velocity at the end solves the inclusion

    v+ - v - h p  in  -(h Q(N)/m) d|v+|_M      so that      v+ = (1 - h Q / (m |v + h p|_M)) (v + h p)

or 0 where that bracket is negative: friction's impulse brings v + h p to rest when it can. Its direction is that of the
end, implicit, hence a part at rest has v = 0 to the bit and a sliding part stops without creeping. Off the mid-plane v
is the velocity of the centre of mass along the surface, and the impulse is that of `after_friction`.

J.J. Moreau, Unilateral contact and dry friction in finite freedom dynamics, 1988.
"""

from __future__ import annotations

import math

from particle.events import (
    ROUNDING,
    Motion,
    Part,
    after_friction,
    by_centre,
    drag,
    grip_at,
    inner,
    of_centre,
    pull,
    push,
)
from particle.jit import inlined
from particle.modes import Mode
from particle.surface import SurfacePoint


@inlined
def moreau_step(
    f: SurfacePoint, part: Part, h: float, mode: int, motion: Motion, after: Motion
) -> tuple[int, float, float, float]:
    """Velocity and energies after h [s] into `after`.

    f: the surface in the middle of the step.  Returns what the part does then, the load [N] as on a flat surface, and
    the way [m] in x and y over the second half of the step.
    """
    v_x, v_y = motion.v_x, motion.v_y
    p = pull(f, v_x, v_y, part)
    limit, load = grip_at(f, part, p.normal)
    c_x, c_y = of_centre(f, part, v_x, v_y)
    free_x, free_y = c_x + h * p.x, c_y + h * p.y
    largest = h * limit / part.mass
    static = largest * part.law.static_ratio if mode == Mode.RESTING else largest
    end_x, end_y, slides = after_friction(f, part, free_x, free_y, largest, static * math.sqrt(ROUNDING))
    # Friction's impulse per kg; it dissipates at the mean velocity.
    lost_x, lost_y = free_x - end_x, free_y - end_y
    mean_x, mean_y = 0.5 * (c_x + end_x), 0.5 * (c_y + end_y)
    after.v_x, after.v_y = by_centre(f, part, end_x, end_y)
    after.work = motion.work + h * push(f, part, p.normal) - part.mass * drag(f, part, lost_x, lost_y)
    after.dissipated = motion.dissipated + part.mass * inner(f, lost_x, lost_y, mean_x, mean_y)
    return (Mode.SLIDING if slides else Mode.RESTING), load, 0.5 * h * after.v_x, 0.5 * h * after.v_y
