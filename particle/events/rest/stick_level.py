"""What holds a part at rest whose mass and contact are in the mid-plane, as polynomials in time.

With g = grad w, U = gravity + w_tt and b the base's acceleration less gravity's share in its plane,

    N - squeeze = m C / s          C = U - b.g
    s^2 |p|^2 = |b|^2 s^2 + U^2 g^2 + 2 U (b.g) - (b.g)^2

for the pull p along the surface, s^2 = 1 + g^2.
"""

from __future__ import annotations

import math

import numpy as np

from particle.drives import ORDER
from particle.events.bernstein import to_bernstein
from particle.events.mechanics import Part
from particle.events.polynomials import dot, narrow, product, second_derivative, total
from particle.events.rest.stick_raised import fill_raised
from particle.friction import friction_limit
from particle.jit import jit, jit_no_arrays
from particle.surface import LocalSurface
from particle.types import FloatArray

DEGREE = 16  # of the squared force along the surface; everything else is raised to it
# A part sticks up to the limit itself, as on a slope at the angle of friction: rounding must not decide.
ROUNDING = 1 + 1e-14


@jit
def fill_level(local: LocalSurface, part: Part, motion: FloatArray, begin: float, end: float, out: FloatArray) -> None:
    """C, the squared force along the surface times s^2, and s^2, from `begin` to `end` [s]: Bernstein form (3, 17).

    With a centre of mass off the mid-plane (6, 37), as in `stick_raised`.
    """
    w_tt, g_x, g_y = second_derivative(motion[0], end - begin), motion[1], motion[2]
    b_x, b_y = np.zeros(ORDER - 2), np.zeros(ORDER - 2)
    if local.frame[0].base_drives > 0:
        base = local.base.T.copy()
        low, width = (begin - local.frame[0].time) / local.frame[0].unit, (end - begin) / local.frame[0].unit
        narrow(base[0], low, width)
        narrow(base[1], low, width)
        b_x, b_y = second_derivative(base[0], end - begin), second_derivative(base[1], end - begin)
    b_x[0] -= part.tilt_x
    b_y[0] -= part.tilt_y
    upright = w_tt.copy()
    upright[0] += part.gravity
    q_2 = dot(g_x, g_y, g_x, g_y)
    b_g = dot(b_x, b_y, g_x, g_y)
    b_2 = dot(b_x, b_y, b_x, b_y)
    c = total(upright, -b_g)
    # s^2 |force|^2 = |b|^2 s^2 + upright^2 q^2 + 2 upright (b.g) - (b.g)^2: what gravity and inertia leave along it.
    force = total(b_2, product(b_2, q_2))
    force = total(force, product(product(upright, upright), q_2))
    force = total(force, total(2 * product(upright, b_g), -product(b_g, b_g)))
    square = q_2.copy()
    square[0] += 1.0
    if part.centre > 0.0:
        fill_raised(c, force, square, b_x, b_y, motion, end - begin, out)
        return
    to_bernstein(c, out[0])
    to_bernstein(force, out[1])
    to_bernstein(square, out[2])


@jit
def is_safe_level(part: Part, rest: FloatArray, slack: float) -> bool:
    """Whether the Bernstein coefficients (3, n) of a subinterval prove that the part stays."""
    c_low, c_high = rest[0].min(), rest[0].max()
    s_low, s_high = math.sqrt(max(1.0, rest[2].min())), math.sqrt(max(1.0, rest[2].max()))
    load_low = part.mass * c_low / (s_high if c_low > 0 else s_low) + part.squeeze
    load_high = part.mass * c_high / (s_low if c_high > 0 else s_high) + part.squeeze
    if load_low < -part.law.pull_off or load_high > part.law.largest_load:
        return False
    limit = part.law.static_ratio * friction_limit(part.law, load_low) / part.mass
    for k in range(rest.shape[1]):
        if rest[1, k] - slack > limit * limit * rest[2, k] * ROUNDING:
            return False
    return True


@jit_no_arrays
def holds_level(part: Part, rest: FloatArray, slack: float) -> bool:
    """Whether the part stays at the end of a subinterval."""
    force, square = rest[1, -1] - slack, rest[2, -1]
    s = math.sqrt(square)
    load = part.mass * rest[0, -1] / s + part.squeeze
    limit = part.law.static_ratio * friction_limit(part.law, load) / part.mass
    return -part.law.pull_off <= load <= part.law.largest_load and force <= limit * limit * square * ROUNDING
