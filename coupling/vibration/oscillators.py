"""Kernels: oscillators under drives, in closed form between the drives' breakpoints.

Between two breakpoints h'' is a cubic, and

    eta'' + 2 zeta omega eta' + omega^2 eta = -sum_i m_i h_i''

has a cubic as one solution, the forced part. What is left rings freely and decays. At a breakpoint where h or h' jumps,
eta and eta' jump by -m times that, since the plate's mass does not jump.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from particle import kernel, kernel_device_no_arrays, kernel_no_arrays
from particle.drives import ORDER, DriveTable, drive_piece, quintic_end

FloatArray = NDArray[np.float64]

ROUNDING = 1e-13  # of a drive's height or velocity: what is no jump
# A quintic with the value and first two derivatives of a sine of angular frequency w at both ends, t apart, is off in
# the second by this times (w t)^4 of the sine's: 3/8 of 1/720.
HERMITE_ERROR = 3 / 8 / 720
SILENT = 0.1  # of the error allowed: weaker ringing need not be followed
MERGED = 1e-9  # of an interval: a mark as close to a piece's begin is that begin
LONGEST = 30.0  # radians of the slowest mode, squared, that pieces over ringing of that last share may take


class Oscillators(NamedTuple):
    """n damped oscillators under N drives."""

    omega: FloatArray  # (n,) rad/s
    damping: FloatArray  # (n,), the ratio zeta, below 1
    participation: FloatArray  # (n, N), m


class Course(NamedTuple):
    """The oscillators in I intervals between breakpoints."""

    edges: FloatArray  # (I+1,) s
    forced: FloatArray  # (I, n, 4) m, powers of the time from -1 at the begin to 1 at the end of an interval
    ringing: FloatArray  # (I, n, 2) m and m/s, the rest and its velocity at the begin


@kernel
def follow(oscillators: Oscillators, table: DriveTable, course: Course, before: FloatArray, state: FloatArray) -> None:
    """Fill a course with what its drives do.

    before: (N, 2) m and m/s, the drives' height and velocity before the first breakpoint; then before the last one.
    state: (n, 2) m and m/s, the oscillators' before the first breakpoint; then before the last one.
    """
    n, count = oscillators.participation.shape
    pieces, jumps = np.empty((count, ORDER)), np.empty((count, 2))
    for k in range(len(course.edges) - 1):
        half = 0.5 * (course.edges[k + 1] - course.edges[k])
        for i in range(count):
            drive_piece(table, i, course.edges[k] + half, half, pieces[i])
            enter_jump(pieces[i], half, before[i], jumps[i])
        for j in range(n):
            _follow_one(oscillators, j, pieces, jumps, half, course.forced[k, j], course.ringing[k, j], state[j])


@kernel_no_arrays
def enter_jump(piece: FloatArray, half: float, before: FloatArray, jump: FloatArray) -> None:
    """By how much height and velocity jump where a piece begins; `before` becomes what they are at its end.

    Rounding is no jump: it would outweigh the acceleration of slow drives.
    """
    begin = begin_rate = end = end_rate = extent = extent_rate = 0.0
    sign = 1.0  # powers of -1
    for m in range(ORDER):
        begin += sign * piece[m]
        begin_rate -= sign * m * piece[m]
        end += piece[m]
        end_rate += m * piece[m]
        extent += abs(piece[m])
        extent_rate += m * abs(piece[m])
        sign = -sign
    jump[0], jump[1] = begin - before[0], begin_rate / half - before[1]
    if abs(jump[0]) <= ROUNDING * (extent + abs(before[0])):
        jump[0] = 0.0
    if abs(jump[1]) <= ROUNDING * (extent_rate / half + abs(before[1])):
        jump[1] = 0.0
    before[0], before[1] = end, end_rate / half


@kernel_device_no_arrays
def _follow_one(
    oscillators: Oscillators,
    j: int,
    pieces: FloatArray,
    jumps: FloatArray,
    half: float,
    forced: FloatArray,
    ringing: FloatArray,
    state: FloatArray,
) -> None:
    """One oscillator in one interval."""
    omega, rate = oscillators.omega[j], 2.0 * oscillators.damping[j] * oscillators.omega[j]
    load_0 = load_1 = load_2 = load_3 = 0.0  # -m h'', times the interval's unit of time squared
    for i in range(len(pieces)):
        m = -oscillators.participation[j, i]
        state[0] += m * jumps[i, 0]
        state[1] += m * jumps[i, 1]
        load_0 += 2.0 * m * pieces[i, 2]
        load_1 += 6.0 * m * pieces[i, 3]
        load_2 += 12.0 * m * pieces[i, 4]
        load_3 += 20.0 * m * pieces[i, 5]
    stiff, drag = (omega * half) ** 2, rate * half
    forced[3] = load_3 / stiff
    forced[2] = (load_2 - 3.0 * drag * forced[3]) / stiff
    forced[1] = (load_1 - 2.0 * drag * forced[2] - 6.0 * forced[3]) / stiff
    forced[0] = (load_0 - drag * forced[1] - 2.0 * forced[2]) / stiff
    ringing[0] = state[0] - (forced[0] - forced[1] + forced[2] - forced[3])
    ringing[1] = state[1] - (forced[1] - 2.0 * forced[2] + 3.0 * forced[3]) / half
    eta, velocity = _rung(omega, oscillators.damping[j], ringing, 2.0 * half)
    state[0] = eta + forced[0] + forced[1] + forced[2] + forced[3]
    state[1] = velocity + (forced[1] + 2.0 * forced[2] + 3.0 * forced[3]) / half


@kernel_device_no_arrays
def _rung(omega: float, damping: float, ringing: FloatArray, time: float) -> tuple[float, float]:
    """Free ringing [m] and its velocity [m/s] after a time [s]."""
    decay, turn = damping * omega, omega * math.sqrt(1.0 - damping**2)
    left, cosine, sine = math.exp(-decay * time), math.cos(turn * time), math.sin(turn * time) / turn
    eta, velocity = ringing[0], ringing[1]
    return (
        left * (eta * cosine + (velocity + decay * eta) * sine),
        left * (velocity * cosine - (omega**2 * eta + decay * velocity) * sine),
    )


@kernel_device_no_arrays
def _at(oscillators: Oscillators, course: Course, k: int, j: int, since: float, out: FloatArray) -> None:
    """One oscillator's value [m], velocity and acceleration, into out (3,), a time [s] after an interval's begin."""
    half = 0.5 * (course.edges[k + 1] - course.edges[k])
    omega, damping, s = oscillators.omega[j], oscillators.damping[j], since / half - 1.0
    eta, velocity = _rung(omega, damping, course.ringing[k, j], since)
    p = course.forced[k, j]
    out[0] = eta + p[0] + s * (p[1] + s * (p[2] + s * p[3]))
    out[1] = velocity + (p[1] + s * (2.0 * p[2] + s * 3.0 * p[3])) / half
    out[2] = -omega * (2.0 * damping * velocity + omega * eta) + (2.0 * p[2] + 6.0 * s * p[3]) / half**2


@kernel
def at_times(oscillators: Oscillators, course: Course, intervals: NDArray[np.int64], times: FloatArray) -> FloatArray:
    """Values [m], velocities and accelerations (3, k, n) at times (k,) [s], each in one of the intervals (k,)."""
    values, n, out = np.empty((3, len(times), len(oscillators.omega))), len(oscillators.omega), np.empty(3)
    for m in range(len(times)):
        for j in range(n):
            _at(oscillators, course, intervals[m], j, times[m] - course.edges[intervals[m]], out)
            for order in range(3):
                values[order, m, j] = out[order]
    return values


@kernel_device_no_arrays
def _step(oscillators: Oscillators, course: Course, k: int, since: float, allowed: float) -> float:
    """How long [s] pieces may be from a time [s] after an interval's begin on; allowed: m/s^2, their error.

    What is too faint for the acceleration still shifts heights, by as much as its acceleration in the time squared.
    """
    fourth, silent, slowest, n = 0.0, 0.0, math.inf, len(oscillators.omega)
    for j in range(n):
        omega, ringing = oscillators.omega[j], course.ringing[k, j]
        amplitude = omega * math.hypot(omega * ringing[0], ringing[1])
        amplitude *= math.exp(-oscillators.damping[j] * omega * since)
        if amplitude * n > SILENT * allowed:
            fourth += amplitude * omega**4
        else:
            silent = max(silent, amplitude * n)
        slowest = min(slowest, omega)
    step = (allowed / (HERMITE_ERROR * fourth)) ** 0.25 if fourth > 0.0 else math.inf
    return min(step, math.sqrt(LONGEST * SILENT * allowed / silent) / slowest) if silent > 0.0 else step


@kernel
def lay_edges(
    oscillators: Oscillators, course: Course, allowed: float, marks: FloatArray
) -> tuple[FloatArray, NDArray[np.int64]]:
    """Where pieces begin [s], after their interval's begin, and the interval of each; allowed: m/s^2, their error.

    They grow longer as the ringing decays. Where they can, they begin at marks (m,) [s], where others do.
    """
    count, begins, intervals, mark = 0, np.empty(1024), np.empty(1024, dtype=np.int64), 0
    for k in range(len(course.edges) - 1):
        length, since = course.edges[k + 1] - course.edges[k], 0.0
        while since < length:
            if count == len(begins):
                begins = np.concatenate((begins, np.empty(count)))
                intervals = np.concatenate((intervals, np.empty(count, dtype=np.int64)))
            begins[count], intervals[count] = since, k
            count += 1
            step = _step(oscillators, course, k, since, allowed)
            left, last = length - since, since
            if step >= left:
                since = length
                continue
            while mark < len(marks) and marks[mark] - course.edges[k] <= since + step:
                last = max(last, marks[mark] - course.edges[k])
                mark += 1
            if last > since + MERGED * length:
                since = last
            else:
                left = min(left, marks[mark] - course.edges[k] - since) if mark < len(marks) else left
                since += 0.5 * left if 2.0 * step > left else step
    return begins[:count].copy(), intervals[:count].copy()


@kernel
def lay_pieces(
    oscillators: Oscillators, course: Course, begins: FloatArray, intervals: NDArray[np.int64]
) -> FloatArray:
    """The quintics (n, S, 6) of pieces, in their time from 0 to 1."""
    n, count = len(oscillators.omega), len(begins)
    rows, a, b = np.empty((n, count, ORDER)), np.empty(3), np.empty(3)
    for m in range(count):
        k = intervals[m]
        same = m + 1 < count and intervals[m + 1] == k
        end = begins[m + 1] if same else course.edges[k + 1] - course.edges[k]
        scale = end - begins[m]
        for j in range(n):
            _at(oscillators, course, k, j, begins[m], a)
            _at(oscillators, course, k, j, end, b)
            _quintic(a, b, scale, rows[j, m])
    return rows


@kernel_device_no_arrays
def _quintic(a: FloatArray, b: FloatArray, scale: float, out: FloatArray) -> None:
    """The quintic between two values (3,) with their derivatives, a time `scale` [s] apart."""
    rise, v_0, v_1 = b[0] - a[0], scale * a[1], scale * b[1]
    a_0, a_1 = scale**2 * a[2], scale**2 * b[2]
    out[0], out[1], out[2] = a[0], v_0, 0.5 * a_0
    out[3], out[4], out[5] = quintic_end(rise, v_0, v_1, a_0, a_1)
