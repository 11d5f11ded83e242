"""Kernels: what accelerates the lowest modes of a plate that stretches and has mass.

The lowest modes q ring; the corrections c follow at once, as their inertia is small beside their stiffness:

    q_n'' = -2 zeta_n omega_n q_n' - omega_n^2 q_n - (1/M_n) dE_m/dq_n - m_n . h''
    0 = K c + dE_m/dc

So c is the equilibrium of a reduced plate whose drives are the heights h and the modes q.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from coupling.stretch import (
    Moment,
    State,
    add_rows,
    clear,
    dot,
    find_equilibrium,
    find_rates,
    follow_equilibrium,
    new_moment,
    new_state,
)
from fem_plate.large_deflection import Forms
from particle import kernel, kernel_device_no_arrays, kernel_inlined
from particle.drives import ORDER, DriveTable, drive_piece, evaluate_piece

FloatArray = NDArray[np.float64]


class Ringing(NamedTuple):
    """A stretching plate with a modes that ring and n corrections that follow them, under N drives."""

    forms: Forms  # of N + a drives, the heights and the modes, and n corrections
    square: FloatArray  # (a,) 1/s^2, omega^2
    drag: FloatArray  # (a,) 1/s, 2 zeta omega
    mass: FloatArray  # (a,), M, in the energy's unit over m^2/s^2
    participation: FloatArray  # (a, N)


class Bench(NamedTuple):
    """What is worked with, made once."""

    moment: Moment
    state: State
    pieces: FloatArray  # (N, 6) m, of the drives, powers of the time from -1 to 1
    heights: FloatArray  # (3, N) m, or N of forces, the drives with two derivatives in time
    lifts: FloatArray  # (3, N + a), drives and modes with two derivatives
    row: FloatArray  # (N + a,)
    membrane_force: FloatArray  # (a,), against each mode
    corrections: FloatArray  # (n,), the corrections, as guessed or last found


@kernel
def new_bench(ringing: Ringing) -> Bench:
    """Room for it."""
    forms, count = ringing.forms, ringing.participation.shape[1]
    both = count + len(ringing.square)
    return Bench(
        new_moment(forms),
        new_state(forms),
        np.zeros((count, ORDER)),
        np.zeros((3, count)),
        np.zeros((3, both)),
        np.zeros(both),
        np.zeros(len(ringing.square)),
        np.zeros(len(forms.load)),
    )


@kernel_device_no_arrays
def enter_pieces(table: DriveTable, begin: float, end: float, bench: Bench) -> None:
    """The drives' pieces between two breakpoints [s]."""
    half = 0.5 * (end - begin)
    for i in range(len(bench.pieces)):  # in the middle, where rounding at the ends cannot mistake it
        drive_piece(table, i, begin + half, half, bench.pieces[i])


@kernel_inlined
def _enter_heights(bench: Bench, s: float, half: float) -> None:
    """The drives with two derivatives in time [s]."""
    heights = bench.heights
    for i in range(len(bench.pieces)):
        heights[0, i], heights[1, i], heights[2, i] = evaluate_piece(bench.pieces[i], s, half)


@kernel_device_no_arrays
def _enter_lifts(ringing: Ringing, bench: Bench, count: int, orders: int) -> None:
    """What drives and modes do to the first `count` forms, with derivatives up to an order below `orders`."""
    forms, moment, lifts, row = ringing.forms, bench.moment, bench.lifts, bench.row
    both = len(row)
    for r in range(count):
        clear(row)
        add_rows(row, 0, both, forms.drives[r], lifts[0], both)
        moment.own[0, r] = 0.5 * dot(lifts[0], row)
        if orders > 1:
            moment.own[1, r] = dot(lifts[1], row)
            moment.own[2, r] = dot(lifts[2], row)
            clear(row)
            add_rows(row, 0, both, forms.drives[r], lifts[1], both)
            moment.own[2, r] += dot(lifts[1], row)
        for order in range(orders):
            mixed = moment.mixed[order, r]
            clear(mixed)
            add_rows(mixed, 0, len(mixed), forms.mixed[r], lifts[order], both)


@kernel_device_no_arrays
def accelerate(
    ringing: Ringing,
    bench: Bench,
    s: float,
    half: float,
    q: FloatArray,
    q_t: FloatArray,
    out: FloatArray,
    reuse_factor: bool,
) -> int:
    """The modes' accelerations (a,) at s of an interval of 2 half [s]; returns what came of the corrections.

    reuse_factor: keep the factor of the last Hessian for Newton's steps; the guess in the bench must be close.
    """
    forms, state, lifts, count = ringing.forms, bench.state, bench.lifts, len(bench.pieces)
    _enter_heights(bench, s, half)
    for i in range(count):
        lifts[0, i] = bench.heights[0, i]
    for k in range(len(q)):
        lifts[0, count + k] = q[k]
    _enter_lifts(ringing, bench, forms.membranes, 1)
    if reuse_factor:
        outcome = follow_equilibrium(forms, bench.moment, state, bench.corrections)
    else:
        outcome = find_equilibrium(forms, bench.moment, state, bench.corrections, 0.0)
    clear(bench.membrane_force)
    for r in range(forms.membranes):
        force = state.values[r]
        for k in range(len(q)):
            own = dot(forms.drives[r, count + k], lifts[0]) + dot(forms.mixed[r, count + k], bench.corrections)
            bench.membrane_force[k] += force * own
    for k in range(len(q)):
        inertia = dot(ringing.participation[k], bench.heights[2])
        stretched = bench.membrane_force[k] / ringing.mass[k]
        out[k] = -ringing.square[k] * q[k] - ringing.drag[k] * q_t[k] - stretched - inertia
    return outcome


@kernel_device_no_arrays
def fill_node(
    ringing: Ringing, bench: Bench, q: FloatArray, q_t: FloatArray, q_tt: FloatArray, out: FloatArray
) -> None:
    """Modes, corrections and in-plane motions with two derivatives (3, a + n + M), where `accelerate` has just been."""
    forms, lifts, count, own = ringing.forms, bench.lifts, len(bench.pieces), len(q)
    for i in range(count):
        lifts[1, i], lifts[2, i] = bench.heights[1, i], bench.heights[2, i]
    for k in range(own):
        lifts[1, count + k], lifts[2, count + k] = q_t[k], q_tt[k]
        out[0, k], out[1, k], out[2, k] = q[k], q_t[k], q_tt[k]
    _enter_lifts(ringing, bench, len(forms.constant), 3)
    followed = out[:, own:]
    for j in range(len(bench.corrections)):
        followed[0, j] = bench.corrections[j]
    find_rates(forms, bench.moment, bench.state, followed)
