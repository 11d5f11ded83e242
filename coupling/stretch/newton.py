"""Kernels: the equilibrium of a reduced plate at one moment, and its derivatives in time.

Each form is C_r = Q + m.c + 1/2 c'C_cc c, where Q and m follow the drives. With f_r its value and v_r = m + C_cc c:

    energy      1/2 c'K c + p'c + 1/2 sum f_r^2
    gradient    K c + p + sum f_r v_r
    Hessian     K + sum v_r v_r' + f_r C_cc
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from coupling.stretch.interval import Moment, add_rows, clear, copy, dot
from fem_plate.large_deflection import Forms
from particle import kernel, kernel_device_no_arrays, kernel_inlined, kernel_no_arrays

FloatArray = NDArray[np.float64]

MAX_STEPS, CONVERGED = 60, 1e-10  # of Newton; a step over the largest correction
SUFFICIENT, MIN_STEP = 1e-4, 1e-10  # the share of the slope by which the energy must fall; of a step
ENERGY_ROUNDING = 1e-13  # of the energy's terms
FOLLOWED, SLOW = 1e-9, 0.3  # with a kept factor: the error left; the most that a step may be of the one before
FINE, NOT_CONVERGED, NOT_STABLE = 0, 1, 2  # what can come of it


class State(NamedTuple):
    """What Newton's method works with; what is flat is the array before it."""

    values: FloatArray  # (S,), f of each form
    rows: FloatArray  # (S, n), v
    rows_flat: FloatArray
    gradient: FloatArray  # (n,)
    hessian: FloatArray  # (n, n), its upper half
    hessian_flat: FloatArray
    factor: FloatArray  # (n, n), Cholesky's upper factor of it
    weights: FloatArray  # (S or n,), of rows
    step: FloatArray  # (n,)
    trial: FloatArray  # (n,)
    values_t: FloatArray  # (S,), f'
    rows_t: FloatArray  # (S, n), v'
    rows_t_flat: FloatArray


@kernel
def new_state(forms: Forms) -> State:
    """Room for it."""
    count, n = len(forms.constant), len(forms.load)
    rows, rows_t, hessian = np.zeros((count, n)), np.zeros((count, n)), np.zeros((n, n))
    return State(
        np.zeros(count),
        rows,
        rows.reshape(-1),
        np.zeros(n),
        hessian,
        hessian.reshape(-1),
        np.zeros((n, n)),
        np.zeros(max(count, n)),
        np.zeros(n),
        np.zeros(n),
        np.zeros(count),
        rows_t,
        rows_t.reshape(-1),
    )


@kernel_no_arrays
def find_equilibrium(forms: Forms, moment: Moment, state: State, c: FloatArray, largest: float) -> int:
    """Move c (n,) to where the energy is least, and leave the state there; largest: of |c| so far.

    Returns FINE, with the factor of the Hessian at the last step but one, or what went wrong.
    """
    n = len(c)
    energy = _enter(forms, moment, state, c)
    for i in range(n):
        largest = max(largest, abs(c[i]))
    for _ in range(MAX_STEPS):
        stable = _factorise(forms, state, True)
        if not stable:
            _factorise(forms, state, False)
        for i in range(n):
            state.step[i] = -state.gradient[i]
        _solve(state.factor, state.step)
        slope = length = 0.0
        for i in range(n):
            slope += state.gradient[i] * state.step[i]
            length = max(length, abs(state.step[i]))
        if not math.isfinite(length):
            return NOT_CONVERGED
        slack, factor = ENERGY_ROUNDING * (abs(energy) + _size(forms, state, c)), 1.0
        while True:
            for i in range(n):
                state.trial[i] = c[i] + factor * state.step[i]
            after = _enter(forms, moment, state, state.trial)
            if after <= energy + SUFFICIENT * factor * slope + slack:
                break
            factor *= 0.5
            if factor < MIN_STEP:
                return NOT_CONVERGED
        energy = after
        for i in range(n):
            c[i] = state.trial[i]
            largest = max(largest, abs(c[i]))
        if length <= CONVERGED * largest:
            return FINE if stable else NOT_STABLE
    return NOT_CONVERGED


@kernel_inlined
def follow_equilibrium(forms: Forms, moment: Moment, state: State, c: FloatArray, exact: bool) -> int:
    """As `find_equilibrium`, near the last one that it found: the factor of that one's Hessian serves all steps.

    exact: whether to end with a step of Newton's, with the factor of its own Hessian; else c is good to FOLLOWED.
    """
    n, last, rate = len(c), math.inf, 1.0
    while True:
        _enter(forms, moment, state, c)
        length, largest = _newton_step(state, c)
        if not length <= SLOW * last:
            return find_equilibrium(forms, moment, state, c, largest)
        if last < math.inf:
            rate = length / last
        for i in range(n):
            c[i] += state.step[i]
        if length * rate <= FOLLOWED * largest:
            break
        last = length
    if not exact:
        for r in range(forms.membranes):
            state.values[r] += dot(state.rows[r], state.step)
        return FINE
    _enter(forms, moment, state, c)
    if not _factorise(forms, state, True):
        return find_equilibrium(forms, moment, state, c, largest)
    _newton_step(state, c)
    for i in range(n):
        c[i] += state.step[i]
    _enter(forms, moment, state, c)
    return FINE


@kernel_device_no_arrays
def _newton_step(state: State, c: FloatArray) -> tuple[float, float]:
    """Find the step that the gradient and the factor ask for; its length, and that of c, by their largest entries."""
    length = largest = 0.0
    for i in range(len(c)):
        state.step[i] = -state.gradient[i]
    _solve(state.factor, state.step)
    for i in range(len(c)):
        length, largest = max(length, abs(state.step[i])), max(largest, abs(c[i]))
    return length, largest


@kernel_device_no_arrays
def find_rates(forms: Forms, moment: Moment, state: State, node: FloatArray) -> None:
    """Fill a node (3, n+M) with c', c'' and with g, g', g'', at the equilibrium c that its first row begins with."""
    n, count, membranes = len(forms.load), len(forms.constant), forms.membranes
    c, c_t, c_tt = node[0, :n], node[1, :n], node[2, :n]
    _enter_forms(forms, moment, state, c, membranes, count)
    for r in range(membranes):
        state.weights[r] = moment.own[1, r] + dot(c, moment.mixed[1, r])
    _answer(forms, moment, state, 1, c_t)
    _enter_rates(forms, moment, state, c, c_t)
    for r in range(membranes):
        state.weights[r] = _second(moment, state, c, c_t, r)
    _answer(forms, moment, state, 2, c_tt)
    for r in range(membranes, count):
        node[0, n + r - membranes] = state.values[r]
        node[1, n + r - membranes] = state.values_t[r]
        node[2, n + r - membranes] = _second(moment, state, c, c_t, r) + dot(state.rows[r], c_tt)


@kernel_no_arrays
def fill_motions(forms: Forms, moment: Moment, state: State, c: FloatArray, out: FloatArray) -> None:
    """The in-plane motions (M,) at the equilibrium c."""
    _enter_forms(forms, moment, state, c, forms.membranes, len(forms.constant))
    for r in range(len(out)):
        out[r] = state.values[forms.membranes + r]


@kernel_device_no_arrays
def _answer(forms: Forms, moment: Moment, state: State, order: int, out: FloatArray) -> None:
    """The corrections' derivative of that order, which keeps the gradient 0; weights (R,): what f has without it."""
    n, membranes = len(out), forms.membranes
    rate, weights = state.step, state.weights
    clear(rate)
    add_rows(rate, 0, n, state.rows, weights, membranes)
    add_rows(rate, 0, n, moment.mixed[order], state.values, membranes)
    if order == 2:
        for r in range(membranes):
            weights[r] = 2.0 * state.values_t[r]
        add_rows(rate, 0, n, state.rows_t, weights, membranes)
    _solve(state.factor, rate)
    for j in range(n):
        out[j] = -rate[j]


@kernel_device_no_arrays
def _second(moment: Moment, state: State, c: FloatArray, c_t: FloatArray, r: int) -> float:
    """f'' of a form, without what c'' adds."""
    mixed_t, mixed_tt = moment.mixed[1, r], moment.mixed[2, r]
    return float(moment.own[2, r] + dot(mixed_tt, c) + (dot(mixed_t, c_t) + dot(state.rows_t[r], c_t)))


@kernel_inlined
def _enter_rates(forms: Forms, moment: Moment, state: State, c: FloatArray, c_t: FloatArray) -> None:
    """f' and v' of all forms."""
    n = len(c)
    copy(moment.mixed_flat[1], state.rows_t_flat)
    add_rows(state.rows_t_flat, 0, len(state.rows_t_flat), forms.corrections, c_t, n)
    for r in range(len(forms.constant)):
        mixed_t = moment.mixed[1, r]
        state.values_t[r] = moment.own[1, r] + dot(mixed_t, c) + dot(state.rows[r], c_t)


@kernel_device_no_arrays
def _enter_forms(forms: Forms, moment: Moment, state: State, c: FloatArray, first: int, last: int) -> None:
    """Values and rows of the forms from `first` to before `last`."""
    n = len(c)
    for j in range(first * n, last * n):
        state.rows_flat[j] = moment.mixed_flat[0, j]
    add_rows(state.rows_flat, first * n, last * n, forms.corrections, c, n)
    for r in range(first, last):
        twice = dot(c, moment.mixed[0, r]) + dot(c, state.rows[r])
        state.values[r] = forms.constant[r] + moment.own[0, r] + 0.5 * twice


@kernel_device_no_arrays
def _enter(forms: Forms, moment: Moment, state: State, c: FloatArray) -> float:
    """Values and rows of the membrane at c, the gradient and the energy, which is returned."""
    n, gradient, values = len(c), state.gradient, state.values
    _enter_forms(forms, moment, state, c, 0, forms.membranes)
    clear(gradient)
    add_rows(gradient, 0, n, forms.stiffness, c, n)
    energy = 0.5 * dot(gradient, c) + dot(forms.load, c)
    for r in range(forms.membranes):
        energy += 0.5 * values[r] * values[r]
    for i in range(n):
        gradient[i] += forms.load[i]
    add_rows(gradient, 0, n, state.rows, values, forms.membranes)
    return float(energy)


@kernel_inlined
def _size(forms: Forms, state: State, c: FloatArray) -> float:
    """The size of the energy's terms, which rounding is measured by."""
    size = 0.0
    for r in range(forms.membranes):
        size += state.values[r] * state.values[r]
    for i in range(len(c)):
        size += abs(forms.load[i] * c[i])
    return size


@kernel_device_no_arrays
def _factorise(forms: Forms, state: State, whole: bool) -> bool:
    """Build the Hessian, or what is positive definite of it, and its Cholesky factor; whether there is one."""
    n, weights = len(forms.load), state.weights
    for i in range(n):
        copy(forms.stiffness[i], state.hessian[i])
    if whole:
        add_rows(state.hessian_flat, 0, n * n, forms.flat, state.values, forms.membranes)
    for i in range(n):
        for r in range(forms.membranes):
            weights[r] = state.rows[r, i]
        add_rows(state.hessian[i], i, n, state.rows, weights, forms.membranes)
    for k in range(n):
        row = state.hessian[k]
        for i in range(k):
            weights[i] = -state.factor[i, k]
        add_rows(row, k, n, state.factor, weights, k)
        if not row[k] > 0.0:
            return False
        root = 1.0 / math.sqrt(row[k])
        for j in range(k, n):
            state.factor[k, j] = row[j] * root
    return True


@kernel_device_no_arrays
def _solve(factor: FloatArray, x: FloatArray) -> None:
    """Solve U'U x = b for the upper factor U (n, n), in place."""
    n = len(x)
    for k in range(n):
        x[k] /= factor[k, k]
        for j in range(k + 1, n):
            x[j] -= x[k] * factor[k, j]
    for k in range(n - 1, -1, -1):
        total = x[k]
        for j in range(k + 1, n):
            total -= factor[k, j] * x[j]
        x[k] = total / factor[k, k]
