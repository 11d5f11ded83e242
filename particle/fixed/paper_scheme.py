"""One step of the paper's own scheme, equations (6) to (12), for comparison.

The part's velocity relative to the surface is a vector in space. At each step it is turned into the local frame, (8):
X along the gradient, Y across it, Z along the normal, where its share along Z is dropped. The surface's acceleration
and gravity, turned likewise, give the external force F_e along X and Y and the normal force along -Z. Then the friction
logic, (6) and (7), with the threshold speed V_T = (F_f/m) dt:

    V_r >= V_T                  F_e and friction F_f against V_r accelerate the part
    V_r <  V_T and F_e > F_f    so they do, with friction against F_e
    else                        the part moves with the surface: V_r = 0

Off the mid-plane the surface's acceleration is that of the place of the centre of mass; all else stays the paper's.
Positions follow by (10), in which R/sin(theta) is the radius of the normal curvature across the gradient.
"""

from __future__ import annotations

import math

import numpy as np

from particle.events import Motion, Part, drag, normal_bend, push
from particle.friction import friction_limit
from particle.jit import inlined
from particle.modes import Mode
from particle.surface import SurfacePoint
from particle.types import FloatArray


@inlined
def rotation(f: SurfacePoint) -> FloatArray:
    """The matrix (3, 3) of equation (8), from global to local components; beta = 0 where the surface is level."""
    slope = math.sqrt(f.w_x * f.w_x + f.w_y * f.w_y)
    c_b, s_b = (f.w_x / slope, f.w_y / slope) if slope > 0.0 else (1.0, 0.0)
    c_t = 1 / math.sqrt(1 + slope * slope)
    s_t = slope * c_t
    return np.array([[c_t * c_b, c_t * s_b, s_t], [-s_b, c_b, 0.0], [-s_t * c_b, -s_t * s_b, c_t]])


@inlined
def across(f: SurfacePoint, turn: FloatArray, way: float) -> tuple[float, float]:
    """Equations (10b) and (10c): the local Y and Z [m] reached by a way [m] along the arc across the gradient."""
    e_x, e_y = turn[1, 0], turn[1, 1]
    # sin(theta) / R, positive where the surface rises to both sides.
    curvature = (f.w_xx * e_x * e_x + 2 * f.w_xy * e_x * e_y + f.w_yy * e_y * e_y) * turn[2, 2]
    angle = curvature * way
    if angle == 0.0:
        return way, 0.0
    return math.sin(angle) / curvature, 2 * math.sin(0.5 * angle) ** 2 / curvature


@inlined
def paper_step(
    f: SurfacePoint, part: Part, h: float, mode: int, motion: Motion, after: Motion
) -> tuple[int, float, float, float]:
    """Velocity and energies after h [s] into `after`, whose v_z is the velocity's global z component.

    f: the surface at the start of the step.  Returns what the part does then, the normal force [N], and the way [m] in
    x and y over the step.
    """
    turn = rotation(f)
    before = np.array([motion.v_x, motion.v_y, motion.v_z])
    inertia = np.array([part.tilt_x - f.base_ax, part.tilt_y - f.base_ay, -part.gravity - f.w_tt])
    if part.centre > 0.0:
        n = normal_bend(f, 0.0, 0.0)
        upright = np.array([n.x, n.y, n.x * f.w_x + n.y * f.w_y])
        for k in range(3):
            inertia[k] -= part.centre * (upright[k] - n.down * turn[2, k])
    v_x, v_y, e_x, e_y, e_z = 0.0, 0.0, 0.0, 0.0, 0.0
    for k in range(3):
        v_x += turn[0, k] * before[k]
        v_y += turn[1, k] * before[k]
        e_x += turn[0, k] * inertia[k]
        e_y += turn[1, k] * inertia[k]
        e_z += turn[2, k] * inertia[k]
    load = part.squeeze - part.mass * e_z
    limit = friction_limit(part.law, load) / part.mass  # F_f / m
    speed, external = math.hypot(v_x, v_y), math.hypot(e_x, e_y)
    held = limit * part.law.static_ratio if mode == Mode.RESTING else limit
    moves, q_x, q_y = True, 0.0, 0.0
    if speed >= limit * h and speed > 0.0:
        q_x, q_y = -limit * v_x / speed, -limit * v_y / speed
    elif external > held:
        q_x, q_y = -limit * e_x / external, -limit * e_y / external
    else:
        moves, q_x, q_y = False, -e_x, -e_y
    u_x, u_y = (v_x + h * (e_x + q_x), v_y + h * (e_y + q_y)) if moves else (0.0, 0.0)
    after.v_x, after.v_y = turn[0, 0] * u_x + turn[1, 0] * u_y, turn[0, 1] * u_x + turn[1, 1] * u_y
    after.v_z = turn[0, 2] * u_x + turn[1, 2] * u_y
    drags = drag(f, part, turn[0, 0] * q_x + turn[1, 0] * q_y, turn[0, 1] * q_x + turn[1, 1] * q_y)
    after.work = motion.work + h * (push(f, part, load) + part.mass * drags)
    after.dissipated = motion.dissipated + h * part.mass * limit * math.hypot(u_x, u_y)
    y, z = across(f, turn, h * u_y)
    way_x = turn[0, 0] * h * u_x + turn[1, 0] * y + turn[2, 0] * z
    way_y = turn[0, 1] * h * u_x + turn[1, 1] * y + turn[2, 1] * z
    return (Mode.SLIDING if moves else Mode.RESTING), load, way_x, way_y
