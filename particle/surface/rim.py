"""The distance from the plate's rim, which consists of whole ellipses and of straight and parabolic edges.

A point is on the plate when the rim encloses it an odd number of times (even-odd rule): each ellipse around it counts
once, and so does each crossing of the edges with a ray towards positive x.

`meshes/nearest.py` has the same formulas for many points at once, in numpy: `particle` knows no meshes, and meshes are
made without numba.
"""

from __future__ import annotations

import math

from particle.jit import device_no_arrays, jit_no_arrays
from particle.surface.record import Surface
from particle.types import FloatArray

Vector = tuple[float, float]

HALVINGS = 54  # of a parameter in [0, 1]
NEWTON_STEPS = 100
STRAIGHT = 1e-28  # squared curvature of an edge, over its squared length, that is rounding
MIN_DIP = 1e-3  # of a step: shorter dips beyond the rim are not looked for,
ROUNDING = 1e-12  # nor shallower ones, of the plate's size


@device_no_arrays
def has_rim(surface: Surface) -> bool:
    """Whether the surface ends anywhere."""
    return len(surface.conics) > 0 or len(surface.edges) > 0


@jit_no_arrays
def rim_gap(surface: Surface, x: float, y: float) -> float:
    """Distance [m] of (x, y) from the rim, negative off the plate; the surface's size where there is no rim."""
    if not has_rim(surface):
        return float(surface.size)
    inside, nearest = False, math.inf
    for k in range(len(surface.conics)):
        conic = surface.conics[k]
        gap = ellipse_gap(x - conic[0], y - conic[1], conic[2], conic[3])
        inside = inside != (gap > 0.0)
        nearest = min(nearest, abs(gap))
    e, square = surface.edges, nearest * nearest
    for k in range(len(e)):
        square = min(square, (x - e[k, 1, 0]) ** 2 + (y - e[k, 1, 1]) ** 2)
    nearest = math.sqrt(square)
    for k in range(len(e)):
        m_x, m_y = e[k, 1, 0], e[k, 1, 1]
        # No point of an edge is farther from its middle than its farther end: far edges need no closer look.
        reach = max(
            (e[k, 0, 0] - m_x) ** 2 + (e[k, 0, 1] - m_y) ** 2, (e[k, 2, 0] - m_x) ** 2 + (e[k, 2, 1] - m_y) ** 2
        )
        away = (x - m_x) ** 2 + (y - m_y) ** 2
        if (e[k, 0, 1] > y) != (e[k, 2, 1] > y) or away <= 1.01 * reach:
            inside = inside != crosses(e[k], x, y)
        if away < (nearest + math.sqrt(reach)) ** 2:
            nearest = min(nearest, edge_distance(e[k], x, y))
    return nearest if inside else -nearest


@device_no_arrays
def ellipse_gap(x: float, y: float, a: float, b: float) -> float:
    """Distance [m] from an ellipse with semi-axes a and b [m] around the origin, positive inside.

    The nearest point is (a^2 x / (t + a^2 - b^2), b^2 y / t), a >= b, with t the largest root of
    g(t) = (a x / (t + a^2 - b^2))^2 + (b y / t)^2 - 1 (D. Eberly, Distance from a point to an ellipse, 2013).
    """
    if a == b:
        return a - math.hypot(x, y)
    x, y = abs(x), abs(y)
    if a < b:
        x, y, a, b = y, x, b, a
    excess = a * a - b * b
    # g falls and is convex, so that Newton's steps from where one of its squares is 1 never pass the root.
    t = max(a * x - excess, b * y)
    if t <= 0.0:  # on the long axis, between the centres of curvature of its ends
        foot_x = a * a * x / excess
        foot_y = b * math.sqrt(max(0.0, 1.0 - (foot_x / a) ** 2))
    else:
        for _ in range(NEWTON_STEPS):
            u, v = a * x / (t + excess), b * y / t
            step = 0.5 * (u * u + v * v - 1.0) / (u * u / (t + excess) + v * v / t)
            if not step > 1e-16 * t:
                break
            t += step
        foot_x, foot_y = a * a * x / (t + excess), b * b * y / t
    distance = math.hypot(x - foot_x, y - foot_y)
    return distance if (x / a) ** 2 + (y / b) ** 2 < 1.0 else -distance


@device_no_arrays
def crosses(edge: FloatArray, x: float, y: float) -> bool:
    """Whether a ray from (x, y) towards positive x crosses an edge (3, 2) an odd number of times.

    It does when it crosses the chord, or else when the point lies between chord and edge: where
    point = start + alpha chord + beta bulge has 0 < beta < 4 alpha (1 - alpha). Points on the line of the chord count
    as a little higher, as in the comparisons with the ends' heights.
    """
    from_x, from_y = x - edge[0, 0], y - edge[0, 1]
    chord_x, chord_y = edge[2, 0] - edge[0, 0], edge[2, 1] - edge[0, 1]
    bulge_x = edge[1, 0] - 0.5 * (edge[0, 0] + edge[2, 0])
    bulge_y = edge[1, 1] - 0.5 * (edge[0, 1] + edge[2, 1])
    height = chord_x * from_y - chord_y * from_x
    side = height
    if side == 0.0:
        side = chord_x if chord_x != 0.0 else -chord_y
    crossed = (edge[0, 1] > y) != (edge[2, 1] > y) and (side > 0.0) == (chord_y > 0.0)
    area = chord_x * bulge_y - chord_y * bulge_x
    if area * side > 0.0:
        alpha = (from_x * bulge_y - from_y * bulge_x) / area
        if height / area < 4 * alpha * (1 - alpha):
            return not crossed
    return crossed


@device_no_arrays
def edge_distance(edge: FloatArray, x: float, y: float) -> float:
    """Distance [m] of (x, y) from an edge (3, 2), by its nearest parameter.

    With the offset d + a s + c s^2 from the point, half the derivative of the squared distance is the cubic
    f = d.a + (a.a + 2 d.c) s + 3 a.c s^2 + 2 c.c s^3. Minima are where it passes zero from below: before the first
    or after the last zero of f'.
    """
    d_x, d_y = edge[0, 0] - x, edge[0, 1] - y
    e_x, e_y = edge[2, 0] - x, edge[2, 1] - y
    m_x, m_y = edge[1, 0] - x, edge[1, 1] - y
    a_x, a_y = 4 * m_x - 3 * d_x - e_x, 4 * m_y - 3 * d_y - e_y
    c_x, c_y = 2 * (d_x + e_x - 2 * m_x), 2 * (d_y + e_y - 2 * m_y)
    f_0, f_1 = d_x * a_x + d_y * a_y, a_x * a_x + a_y * a_y + 2 * (d_x * c_x + d_y * c_y)
    f_2, f_3 = 3 * (a_x * c_x + a_y * c_y), 2 * (c_x * c_x + c_y * c_y)
    if f_3 <= STRAIGHT * f_1:
        s = min(max(-f_0 / f_1, 0.0), 1.0)
        return math.hypot(d_x + s * a_x, d_y + s * a_y)
    root = f_2 * f_2 - 3 * f_3 * f_1
    first, last = 1.0, 1.0
    if root > 0.0:
        first = min(max((-f_2 - math.sqrt(root)) / (3 * f_3), 0.0), 1.0)
        last = min(max((-f_2 + math.sqrt(root)) / (3 * f_3), 0.0), 1.0)
    nearest = min(math.hypot(d_x, d_y), math.hypot(e_x, e_y))
    for low, high in ((0.0, first), (last, 1.0)):
        for _ in range(HALVINGS):
            s = 0.5 * (low + high)
            if f_0 + s * (f_1 + s * (f_2 + s * f_3)) < 0.0:
                low = s
            else:
                high = s
        s = 0.5 * (low + high)
        nearest = min(nearest, math.hypot(d_x + s * (a_x + s * c_x), d_y + s * (a_y + s * c_y)))
    return nearest


@device_no_arrays
def first_beyond(surface: Surface, gap: float, start: Vector, end: Vector, v_0: Vector, v_1: Vector, h: float) -> float:
    """The share of a step of h [s] after which its path is first seen off the plate; 1 when it is not.

    The path is the cubic from `start` to `end` (x, y) [m] with the velocities v_0 and v_1 (x, y) [m/s] there;
    `gap` [m] is the start's distance from the rim. No point of the rim is closer than that, so the search strides.
    """
    x_0, y_0, x_1, y_1 = start[0], start[1], end[0], end[1]
    b_x, b_y, c_x, c_y = x_0 + h * v_0[0] / 3, y_0 + h * v_0[1] / 3, x_1 - h * v_1[0] / 3, y_1 - h * v_1[1] / 3
    # The Bezier polygon's longest side: no point of the path is faster.
    fastest = 3 * max(
        math.hypot(b_x - x_0, b_y - y_0), math.hypot(c_x - b_x, c_y - b_y), math.hypot(x_1 - c_x, y_1 - c_y)
    )
    s = 0.0
    while True:
        s += max(gap / fastest, MIN_DIP) if fastest > 0.0 else 1.0
        if s >= 1.0:
            return 1.0
        r = 1.0 - s
        w_0, w_b, w_c, w_1 = r * r * r, 3 * r * r * s, 3 * r * s * s, s * s * s
        gap = rim_gap(
            surface, w_0 * x_0 + w_b * b_x + w_c * c_x + w_1 * x_1, w_0 * y_0 + w_b * b_y + w_c * c_y + w_1 * y_1
        )
        if gap < -ROUNDING * surface.size:
            return s
