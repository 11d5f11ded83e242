"""Where a face with a local contact stands over the surface: its gap, and what friction gives there.

Over a surface whose second derivatives in the body's axes are H, the gap under a flat face is, in roughnesses sigma,

    d(rho) = z + t.rho/R - rho.H rho/(2 sigma),      R the reach of the face

and (z, t) makes the potential int psi(d) dA + N z + M.t least, psi' = a - p: it bears the load N = int (p - a) dA and
its moments M = int (p - a) rho/R dA. There may be several such gaps. The first is reached from a closed one by Newton's
method, downhill in the potential; from a ridge of it the face tilts to a side. From then on a sliding part's gap is
followed, and contact ends where it is no longer stable: the face comes off, or rocks over, which no path follows.

Tractions q(d) give friction's wrench as in `wrench`: q and its gradient at the centre of rotation, or at the rim
towards it, in closed form; the rest, which vanishes there, by the rule over the face.
"""

from __future__ import annotations

import math
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from particle.body.face import Face
from particle.body.wrench import FAR, fill_wrenches
from particle.friction import FrictionLaw, pressures, rule_for, spread_of
from particle.jit import device_no_arrays, jit
from particle.records import Record
from particle.types import FloatArray

TURNS, HALVINGS = 100, 40  # Newton's steps, and halvings of one
SETTLED = 1e-9  # roughnesses, the last step: the next would be its square
LONGEST, FASTER = 0.5, 0.1  # the longest step: roughnesses, and a share of the tilt to add
STABLE, FLATTER = 1e-9, 1e-3  # of the largest stiffness: the least counts as positive above, and is raised to, these
OPEN = 12.0  # roughnesses, from where on no asperity touches
CLOSED = 1.0  # roughnesses, the least gap from which the search begins
PULLS = 20  # halvings for the pull that ends contact


class Press(Record):
    """Scratch memory of a face's gap."""

    bend: Annotated[FloatArray, 3]  # xx, xy and yy of H [1/m]
    gap: Annotated[FloatArray, 3]  # z and t of the last gap that bore its load [roughnesses]
    give: Annotated[FloatArray, 3, 3]  # its derivatives by the load [1/N], negative definite
    stands: int  # 1 once a gap has borne a load
    trial: Annotated[FloatArray, 3]  # the gap looked at
    excess: Annotated[FloatArray, 3]  # the load less what it bears [N]
    stiffness: Annotated[FloatArray, 3, 3]  # [N]
    inverse: Annotated[FloatArray, 3, 3]  # of the stiffness
    step: Annotated[FloatArray, 3]
    closest: float  # roughnesses, the least gap under the face
    stability: float  # the least eigenvalue of the stiffness over the largest
    pulled: Annotated[FloatArray, 3]  # a load


@device_no_arrays
def press(law: FrictionLaw, face: Face, load: FloatArray, p: Press, anew: bool) -> bool:
    """Find the gap (z, t) under the load (N, M_1, M_2) into p.gap; False where the contact has ended.

    anew: whether to look from a closed gap, too, where the last cannot be followed to it.
    """
    if p.stands == 1:
        for i in range(3):
            p.trial[i] = p.gap[i]
        if _descend(law, face, load, p, 0.0):
            return True
        if not anew:
            return False
    for side in (1.0, -1.0):
        p.trial[0], p.trial[1], p.trial[2] = CLOSED + _highest(law, p), 0.0, 0.0
        if _descend(law, face, load, p, side):
            return True
    return False


@device_no_arrays
def comes_off(p: Press) -> bool:
    """Whether a gap that was not stable opens rather than tilts."""
    least, largest = _eigenvalues(p.stiffness)
    _fill_inverse(p.stiffness, FLATTER * largest - least, p.inverse)
    _fill_ridge(p.inverse, 1.0, p.step)
    return abs(p.step[0]) > max(abs(p.step[1]), abs(p.step[2]))


@device_no_arrays
def pull_to_end(law: FrictionLaw, face: Face, load: FloatArray, p: Press) -> float:
    """The pull [N] that ends the contact if it is added to a load, at its moments; 0 where it has ended already."""
    if not press(law, face, load, p, True):
        return 0.0
    low, high = 0.0, max(load[0] + law.pull_off, 0.0)
    p.pulled[1], p.pulled[2] = load[1], load[2]
    for _ in range(PULLS):
        middle = 0.5 * (low + high)
        p.pulled[0] = load[0] - middle
        for i in range(3):
            p.trial[i] = p.gap[i]
        if _descend(law, face, p.pulled, p, 0.0):
            low = middle
        else:
            high = middle
    press(law, face, load, p, True)
    return low


@jit
def gaps(
    law: FrictionLaw, face: Face, loads: FloatArray, bends: FloatArray, slips: FloatArray, scratch: NDArray[Press]
) -> FloatArray:
    """The gap z, t, friction's wrench against a slip, and the pull that ends contact, (n, 7), each found anew.

    Under loads (N, M_1, M_2) (n, 3) on surfaces with xx, xy, yy of H (n, 3) against slips (n, 3); nan where there is no
    contact. scratch: (1,) a record of the kind that a path has.
    """
    out, wrenches, friction = np.full((len(loads), 7), np.nan), np.zeros((3, 3)), np.zeros((3, 4))
    p = scratch[0]
    for n in range(len(loads)):
        p.bend[:] = bends[n]
        p.stands = 0
        if press(law, face, loads[n], p, True):
            fill_pressed_friction(law, face, slips[n, 0], slips[n, 1], slips[n, 2], p, wrenches, friction)
            for i in range(3):
                out[n, i], out[n, 3 + i] = p.gap[i], friction[i, 0]
            out[n, 6] = pull_to_end(law, face, loads[n], p)
    return out


@device_no_arrays
def _gap_at(c: FloatArray, k: int, g: FloatArray, p: Press) -> float:
    """d at the k-th of `law.places`."""
    return float(
        g[0] + g[1] * c[k, 4] + g[2] * c[k, 5] - (c[k, 0] * p.bend[0] + c[k, 1] * p.bend[1] + c[k, 2] * p.bend[2])
    )


@device_no_arrays
def _rule(law: FrictionLaw, p: Press) -> tuple[int, int]:
    """The rule over the face for the surface under it."""
    spread = spread_of(law, p.bend[0], p.bend[1], p.bend[2])
    return rule_for(law, spread) if spread < math.inf else (0, 0)  # off the plate


@device_no_arrays
def _highest(law: FrictionLaw, p: Press) -> float:
    """The surface's highest point under the face, in roughnesses over the middle."""
    (first, end), highest, c = _rule(law, p), -math.inf, law.places
    for k in range(first, end):
        highest = max(highest, c[k, 0] * p.bend[0] + c[k, 1] * p.bend[1] + c[k, 2] * p.bend[2])
    return highest


@device_no_arrays
def _fill_sums(law: FrictionLaw, face: Face, load: FloatArray, p: Press) -> None:
    """The excess and the stiffness of p.trial, and how close it is."""
    first, end = _rule(law, p)
    n = n_x = n_y = k_11 = k_12 = k_13 = k_22 = k_23 = k_33 = 0.0
    closest, c = math.inf, law.places
    for k in range(first, end):
        x, y, d = c[k, 4], c[k, 5], _gap_at(c, k, p.trial, p)
        closest = min(closest, d)
        found = pressures(law, d)
        f, s = c[k, 3] * found.net, -c[k, 3] * found.slope
        n, n_x, n_y = n + f, n_x + f * x, n_y + f * y
        k_11, k_12, k_13 = k_11 + s, k_12 + s * x, k_13 + s * y
        k_22, k_23, k_33 = k_22 + s * x * x, k_23 + s * x * y, k_33 + s * y * y
    p.excess[0], p.excess[1], p.excess[2] = load[0] - n, -load[2] / face.reach - n_x, load[1] / face.reach - n_y
    m = p.stiffness
    m[0, 0], m[1, 1], m[2, 2] = k_11, k_22, k_33
    m[0, 1], m[0, 2], m[1, 2] = k_12, k_13, k_23
    m[1, 0], m[2, 0], m[2, 1] = k_12, k_13, k_23
    p.closest = closest


@device_no_arrays
def _eigenvalues(m: FloatArray) -> tuple[float, float]:
    """The least and the largest eigenvalue of a symmetric matrix (3, 3), in closed form."""
    mean = (m[0, 0] + m[1, 1] + m[2, 2]) / 3
    a, b, c = m[0, 0] - mean, m[1, 1] - mean, m[2, 2] - mean
    d, e, f = m[0, 1], m[0, 2], m[1, 2]
    size = math.sqrt((a * a + b * b + c * c + 2 * (d * d + e * e + f * f)) / 6)
    if size == 0.0:
        return mean, mean
    det = (a * (b * c - f * f) - d * (d * c - f * e) + e * (d * f - b * e)) / (2 * size**3)
    angle = math.acos(min(max(det, -1.0), 1.0)) / 3
    return mean + 2 * size * math.cos(angle + 2 * math.pi / 3), mean + 2 * size * math.cos(angle)


@device_no_arrays
def _fill_inverse(m: FloatArray, shift: float, out: FloatArray) -> None:
    """The inverse of a symmetric matrix (3, 3) plus a multiple of 1."""
    a, b, c, d, e, f = m[0, 0] + shift, m[1, 1] + shift, m[2, 2] + shift, m[0, 1], m[0, 2], m[1, 2]
    det = a * (b * c - f * f) - d * (d * c - f * e) + e * (d * f - b * e)
    out[0, 0], out[1, 1], out[2, 2] = (b * c - f * f) / det, (a * c - e * e) / det, (a * b - d * d) / det
    out[0, 1] = out[1, 0] = (e * f - d * c) / det
    out[0, 2] = out[2, 0] = (d * f - b * e) / det
    out[1, 2] = out[2, 1] = (d * e - a * f) / det


@device_no_arrays
def _descend(law: FrictionLaw, face: Face, load: FloatArray, p: Press, side: float) -> bool:
    """Newton's method from p.trial, downhill, to a least potential, into p.gap; False where it runs off.

    On a ridge of the potential, where no force drives it, it goes to a side: 1 or -1. With a side of 0 it gives up
    where the gap is not stable.
    """
    _fill_sums(law, face, load, p)
    for _ in range(TURNS):
        least, largest = _eigenvalues(p.stiffness)
        if not (math.isfinite(largest) and largest > 0.0) or p.closest > OPEN:
            return False
        p.stability = least / largest
        if side == 0.0 and p.stability <= STABLE:
            return False
        shift = 0.0 if p.stability > STABLE else FLATTER * largest - least
        _fill_inverse(p.stiffness, shift, p.inverse)
        longest = 0.0
        for i in range(3):
            p.step[i] = -(p.inverse[i, 0] * p.excess[0] + p.inverse[i, 1] * p.excess[1] + p.inverse[i, 2] * p.excess[2])
            longest = max(longest, abs(p.step[i]))
        if longest < SETTLED:
            if shift == 0.0:
                for i in range(3):
                    p.gap[i] = p.trial[i] + p.step[i]
                    for j in range(3):
                        p.give[i, j] = -p.inverse[i, j]
                p.stands = 1
                return True
            _fill_ridge(p.inverse, side, p.step)
            longest = 1.0
        share, before = min(1.0, (LONGEST + FASTER * (abs(p.trial[1]) + abs(p.trial[2]))) / longest), 0.0
        for i in range(3):
            p.step[i] *= share
            before += p.excess[i] * p.step[i]
        # Downhill all the way: not so far that the force turns round.
        for _ in range(HALVINGS):
            for i in range(3):
                p.trial[i] += p.step[i]
            _fill_sums(law, face, load, p)
            after = 0.0
            for i in range(3):
                after += p.excess[i] * p.step[i]
            if after <= 0.5 * abs(before):
                break
            before *= 0.5
            for i in range(3):
                p.trial[i] -= p.step[i]
                p.step[i] *= 0.5
    return False


@device_no_arrays
def _fill_ridge(inverse: FloatArray, side: float, out: FloatArray) -> None:
    """The direction in which the stiffness is least, by the power method with the shifted inverse."""
    out[0], out[1], out[2] = 0.3 * side, side, 0.7 * side
    for _ in range(3):
        a, b, c = out[0], out[1], out[2]
        size = 0.0
        for i in range(3):
            out[i] = inverse[i, 0] * a + inverse[i, 1] * b + inverse[i, 2] * c
            size = max(size, abs(out[i]))
        for i in range(3):
            out[i] /= size


@device_no_arrays
def fill_pressed_friction(
    law: FrictionLaw, face: Face, s_1: float, s_2: float, s_3: float, p: Press, wrenches: FloatArray, out: FloatArray
) -> None:
    """Friction's wrench (f_1, f_2, tau) against the slip s at p.gap, and its derivatives by (N, M_1, M_2).

    out: (3, 4), the wrench in the first column. wrenches: (3, 3), scratch.
    """
    (first, end), c, reach, g = _rule(law, p), law.places, face.reach, p.gap
    for i in range(3):
        for j in range(4):
            out[i, j] = 0.0
    base = along_x = along_y = 0.0
    if s_1 * s_1 + s_2 * s_2 <= (FAR * reach * s_3) ** 2 and s_3 != 0.0:
        x, y = _on_face(face, -s_2 / s_3, s_1 / s_3)
        xx, xy, yy = p.bend[0] / law.roughness, p.bend[1] / law.roughness, p.bend[2] / law.roughness
        found = pressures(law, g[0] + (g[1] * x + g[2] * y) / reach - 0.5 * (xx * x * x + 2 * xy * x * y + yy * y * y))
        along_x = found.limit_slope * (g[1] / reach - xx * x - xy * y)
        along_y = found.limit_slope * (g[2] / reach - xy * x - yy * y)
        base = found.limit - along_x * x - along_y * y
        fill_wrenches(face, s_1, s_2, s_3, wrenches)
        for i in range(3):
            out[i, 0] = base * wrenches[i, 0] + along_x * wrenches[i, 1] + along_y * wrenches[i, 2]
    for k in range(first, end):
        x, y = reach * c[k, 4], reach * c[k, 5]
        u_1, u_2 = s_1 - s_3 * y, s_2 + s_3 * x
        speed = math.sqrt(u_1 * u_1 + u_2 * u_2)
        if not speed > 0.0:
            continue
        found = pressures(law, _gap_at(c, k, g, p))
        e_1, e_2 = -u_1 / speed, -u_2 / speed
        torque = x * e_2 - y * e_1
        q = c[k, 3] * (found.limit - base - along_x * x - along_y * y)
        out[0, 0], out[1, 0], out[2, 0] = out[0, 0] + q * e_1, out[1, 0] + q * e_2, out[2, 0] + q * torque
        if found.limit_slope != 0.0:
            for j in range(3):
                q = p.give[0, j] + p.give[1, j] * c[k, 4] + p.give[2, j] * c[k, 5]
                q *= c[k, 3] * found.limit_slope
                out[0, 1 + j] += q * e_1
                out[1, 1 + j] += q * e_2
                out[2, 1 + j] += q * torque
    for i in range(3):  # from int (p - a) rho/R dA to M
        by_x, by_y = out[i, 2], out[i, 3]
        out[i, 2], out[i, 3] = by_y / reach, -by_x / reach


@device_no_arrays
def _on_face(face: Face, x: float, y: float) -> tuple[float, float]:
    """A place, or where the line to it from the middle leaves the disc or the polygon's hull."""
    share = 1.0
    if face.radius > 0.0:
        share = min(share, face.radius / max(math.hypot(x, y), 1e-300))
    for k in range(len(face.hull)):
        a_x, a_y = face.hull[k - 1, 0], face.hull[k - 1, 1]
        n_x, n_y = face.hull[k, 1] - a_y, a_x - face.hull[k, 0]
        out = n_x * x + n_y * y
        if out > 0.0:
            share = min(share, (n_x * a_x + n_y * a_y) / out)
    return share * x, share * y
