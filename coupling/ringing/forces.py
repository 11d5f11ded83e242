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
from particle import grouped, kernel, kernel_device_no_arrays, kernel_inlined
from particle.drives import ORDER, DriveTable, drive_piece, evaluate_piece

FloatArray = NDArray[np.float64]


@grouped
class Ringing(NamedTuple):
    """A stretching plate with a modes that ring and n corrections that follow them, under N drives.

    Its forms are of N + a lifts, the heights and the modes, and n corrections. The arrays after `forms` have what lifts
    do to all S forms side by side, so that few long rows are added.
    """

    forms: Forms
    pairs: FloatArray  # (P, S), each form's share of the products of two lifts, P = (N + a) (N + a + 1) / 2
    mixed: FloatArray  # (N + a, S * n), of lifts and corrections
    of_modes: FloatArray  # (R, a * (N + a + n)), the membrane's forms of modes with lifts and corrections
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
    products: FloatArray  # (P,), of two lifts
    of_modes: FloatArray  # (a * (N + a + n),), membrane forces times `Ringing.of_modes`
    corrections: FloatArray  # (n,), the corrections, as guessed or last found


def ringing_of(forms: Forms, square: FloatArray, drag: FloatArray, mass: FloatArray, m: FloatArray) -> Ringing:
    """The plate with these forms, whose last drives are the a modes; m: (a, N) their participation."""
    i, j = np.triu_indices(forms.drives.shape[1])
    modes, membranes = slice(m.shape[1], None), forms.membranes
    of_modes = np.concatenate([forms.drives[:membranes, modes], forms.mixed[:membranes, modes]], axis=2)
    return Ringing(
        forms,
        np.where(i == j, 0.5, 1.0)[:, None] * forms.drives[:, i, j].T,
        forms.mixed.transpose(1, 0, 2).reshape(len(forms.drives[0]), -1),
        of_modes.reshape(membranes, -1),
        square,
        drag,
        mass,
        m,
    )


def driven_by_powers(ringing: Ringing, pieces: FloatArray) -> Ringing:
    """The plate under drives s^0 to s^5 instead of its N drives, whose pieces (N, 6) are sums of these powers."""
    m, forms = ringing.participation, ringing.forms
    count, modes = m.shape[1], np.eye(len(m))
    turn = np.block([[pieces.T, np.zeros((ORDER, len(m)))], [np.zeros((len(m), count)), modes]])
    forms = forms._replace(drives=turn @ forms.drives @ turn.T, mixed=turn @ forms.mixed)
    return ringing_of(forms, ringing.square, ringing.drag, ringing.mass, m @ pieces)


@kernel
def new_bench(ringing: Ringing) -> Bench:
    """Room for it."""
    forms, count = ringing.forms, ringing.participation.shape[1]
    return Bench(
        new_moment(forms),
        new_state(forms),
        np.zeros((count, ORDER)),
        np.zeros((3, count)),
        np.zeros((3, len(ringing.mixed))),
        np.zeros(len(ringing.pairs)),
        np.zeros(ringing.of_modes.shape[1]),
        np.zeros(len(forms.load)),
    )


@kernel
def pieces_between(table: DriveTable, begin: float, end: float) -> FloatArray:
    """The drives' pieces (N, 6) between two breakpoints [s]."""
    half, count = 0.5 * (end - begin), len(table.delay)
    pieces = np.zeros((count, ORDER))
    for i in range(count):  # in the middle, where rounding at the ends cannot mistake it
        drive_piece(table, i, begin + half, half, pieces[i])
    return pieces


@kernel_inlined
def _enter_heights(bench: Bench, s: float, half: float) -> None:
    """The drives with two derivatives in time [s]."""
    heights = bench.heights
    for i in range(len(bench.pieces)):
        heights[0, i], heights[1, i], heights[2, i] = evaluate_piece(bench.pieces[i], s, half)


@kernel_device_no_arrays
def _enter_lifts(ringing: Ringing, bench: Bench, count: int, orders: int) -> None:
    """What drives and modes do to the first `count` forms, with derivatives up to an order below `orders`."""
    moment, lifts, products = bench.moment, bench.lifts, bench.products
    size, n = lifts.shape[1], len(bench.corrections)
    for order in range(orders):
        pair = 0
        for i in range(size):
            for j in range(i, size):
                if order == 0:
                    products[pair] = lifts[0, i] * lifts[0, j]
                else:
                    products[pair] = lifts[order, i] * lifts[0, j] + lifts[0, i] * lifts[order, j]
                if order == 2:
                    products[pair] += 2.0 * lifts[1, i] * lifts[1, j]
                pair += 1
        own, mixed = moment.own[order], moment.mixed_flat[order]
        clear(own)
        add_rows(own, 0, count, ringing.pairs, products, pair)
        clear(mixed)
        add_rows(mixed, 0, count * n, ringing.mixed, lifts[order], size)


@kernel_device_no_arrays
def accelerate(
    ringing: Ringing,
    bench: Bench,
    s: float,
    half: float,
    q: FloatArray,
    q_t: FloatArray,
    out: FloatArray,
    near: bool,
    exact: bool,
) -> int:
    """The modes' accelerations (a,) at s of an interval of 2 half [s]; returns what came of the corrections.

    near: whether the guess in the bench is close, so that the factor of the last Hessian serves.
    exact: whether the corrections must be, and the factor that of the Hessian there.
    """
    forms, state, lifts, count = ringing.forms, bench.state, bench.lifts, len(bench.pieces)
    c, of_modes, size = bench.corrections, bench.of_modes, bench.lifts.shape[1]
    _enter_heights(bench, s, half)
    for i in range(count):
        lifts[0, i] = bench.heights[0, i]
    for k in range(len(q)):
        lifts[0, count + k] = q[k]
    _enter_lifts(ringing, bench, forms.membranes, 1)
    if near:
        outcome = follow_equilibrium(forms, bench.moment, state, c, exact)
    else:
        outcome = find_equilibrium(forms, bench.moment, state, c, 0.0)
    clear(of_modes)
    add_rows(of_modes, 0, len(of_modes), ringing.of_modes, state.values, forms.membranes)
    width = size + len(c)
    for k in range(len(q)):
        first = k * width
        stretched = dot(of_modes[first : first + size], lifts[0]) + dot(of_modes[first + size : first + width], c)
        inertia = dot(ringing.participation[k], bench.heights[2])
        out[k] = -ringing.square[k] * q[k] - ringing.drag[k] * q_t[k] - stretched / ringing.mass[k] - inertia
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
