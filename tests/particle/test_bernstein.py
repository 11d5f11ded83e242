"""Bernstein form: conversion, halving, and the first negative place against numpy's roots."""

import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from numpy.polynomial import Polynomial

from particle.events.polynomials import MAX_HALVINGS, divide, first_negative, quintic_to_bernstein, to_bernstein

NUMBERS = st.floats(-1, 1, allow_subnormal=False)
ROUNDING = 64 * np.finfo(float).eps


def bernstein(coefficients, size=None):
    out = np.empty(size or len(coefficients))
    to_bernstein(np.asarray(coefficients, dtype=float), out)
    return out


def exact(b, s):
    """The value of a Bernstein form at a fraction s, without rounding."""
    row = [Fraction(value) for value in b]
    while len(row) > 1:
        row = [left + s * (right - left) for left, right in zip(row, row[1:], strict=False)]
    return row[0]


def monomials(b):
    """The polynomial of Bernstein coefficients b, by exact differences."""
    row, powers = [Fraction(value) for value in b], []
    for k in range(len(b)):
        powers.append(float(math.comb(len(b) - 1, k) * row[0]))
        row = [right - left for left, right in zip(row, row[1:], strict=False)]
    return Polynomial(powers)


@settings(deadline=None)
@given(st.lists(NUMBERS, min_size=1, max_size=8), st.integers(0, 9), st.floats(0, 1))
def test_a_polynomial_keeps_its_values_in_bernstein_form_of_any_degree(c, more, s):
    b = bernstein(c, len(c) + more)
    assert float(exact(b, Fraction(s))) == pytest.approx(Polynomial(c)(s), abs=1e-11)


@settings(deadline=None)
@given(st.lists(NUMBERS, min_size=1, max_size=17), st.floats(0, 1), st.floats(0, 1))
def test_the_parts_are_the_polynomial_on_either_side_of_a_division(b, s, share):
    right, left = np.array(b), np.empty(len(b))
    divide(right, left, share)
    t, at = Fraction(s), Fraction(share)
    assert float(exact(left, t)) == pytest.approx(float(exact(b, at * t)), abs=1e-14)
    assert float(exact(right, t)) == pytest.approx(float(exact(b, at + (1 - at) * t)), abs=1e-14)
    assert right[-1] == b[-1] and left[0] == b[0]


@settings(max_examples=100, deadline=None)
@given(st.lists(NUMBERS, min_size=2, max_size=17))
def test_the_first_negative_place_is_the_first_odd_root_of_numpy(b):
    """Where numpy's roots are distinguished from each other and from the ends; the others are met below."""
    p = monomials(b)
    assume(np.abs(b).max() > 1e-3)
    roots = p.roots()
    near = roots[(np.abs(roots.imag) < 1e-3) & (roots.real > -1e-3) & (roots.real < 1 + 1e-3)]
    assume((np.abs(near.imag) < 1e-12).all())
    real = np.sort(near.real)
    assume((np.diff(np.concatenate([[-2e-3], real, [1 + 2e-3]])) > 1e-3).all())
    assume(not ((np.abs(real) < 1e-4) | (np.abs(real - 1) < 1e-4)).any())
    inside = real[(real > 0) & (real < 1)]
    slopes = np.abs(p.deriv()(inside))
    assume((slopes > 1e-4).all())
    found = first_negative(np.array(b))
    if b[0] < 0:
        assert found == 0.0
    elif len(inside):
        bound = 1e-10 + 1e3 * ROUNDING * np.abs(p.coef).max() / slopes[0]  # numpy's roots lose digits
        assert found == pytest.approx(inside[0], abs=bound)
    else:
        assert found == math.inf


@settings(max_examples=100, deadline=None)
@given(st.lists(st.floats(-1, 1).map(lambda x: round(x, 2)), min_size=1, max_size=17))
def test_what_is_passed_over_is_nowhere_negative_and_what_is_found_is(b):
    """Without roots: before the place found nothing is negative, right behind it something is. In exact numbers."""
    found = first_negative(np.array(b))
    end = Fraction(1) if found == math.inf else Fraction(found)
    before = range(61) if found == math.inf else range(60)
    assert all(exact(b, end * k / 60) >= -ROUNDING for k in before) or found == 0.0
    if found < math.inf:
        # The place is the left end of an interval of at most 2^-MAX_HALVINGS at whose ends the polynomial is negative.
        width = Fraction(1, 2**MAX_HALVINGS)
        assert min(exact(b, end), exact(b, min(Fraction(1), end + width))) < ROUNDING
    if b[0] < 0:
        assert found == 0.0
    if min(b) >= 0:
        assert found == math.inf


@pytest.mark.parametrize("degree", [1, 3, 5, 16])
@given(place=st.floats(1e-6, 1 - 1e-6))
@settings(max_examples=40, deadline=None)
def test_a_single_crossing_is_located_to_the_last_halving(degree, place):
    """(s0 - s)(1 + s)^(n-1) changes its sign once."""
    p = Polynomial([place, -1.0]) * Polynomial([1.0, 1.0]) ** (degree - 1)
    b = bernstein(p.coef)
    assert first_negative(b) == pytest.approx(place, abs=2 * 0.5**MAX_HALVINGS + 1e3 * np.finfo(float).eps)
    assert first_negative(-b) == 0.0


@settings(deadline=None)
@given(st.floats(0.05, 0.9), st.floats(1e-7, 1e-2))
def test_a_brief_dip_is_not_stepped_over(place, width):
    """Negative between s0 and s0 + width only, and not sooner."""
    p = Polynomial.fromroots([place, place + width])
    found = first_negative(bernstein(p.coef, 7))
    assert found == pytest.approx(place, abs=1e-13 + 1e-15 / width)


@pytest.mark.parametrize("numerator", [1, 3, 8, 11, 13])
def test_a_root_that_only_touches_is_no_crossing(numerator):
    """(s - k/16)^2, exact in floating point."""
    place = numerator / 16
    assert first_negative(np.array([place**2, place**2 - place, (1 - place) ** 2])) == math.inf
    assert first_negative(-np.array([place**2, place**2 - place, (1 - place) ** 2])) == 0.0


@pytest.mark.parametrize(
    "b, place",
    [
        ([0.0], math.inf),
        ([-1e-300], 0.0),
        ([0.0, 1.0], math.inf),
        ([0.0, -1.0], 0.0),
        ([1.0, 0.0], math.inf),
        ([0.0, 0.0, -1.0], 0.0),
        ([0.0, 1.0, -1.0], 2 / 3),
        ([0.0, 0.0, 0.0], math.inf),
        ([1.0, -1.0, 1.0], math.inf),  # (1 - 2 s)^2
        ([1.0, -1.0 - 1e-9, 1.0], 0.5),
    ],
)
def test_ends_and_degenerate_rows(b, place):
    assert first_negative(np.array(b)) == pytest.approx(place, abs=5e-5 if len(b) == 3 and b[1] < -1 else 1e-13)


@given(st.lists(NUMBERS, min_size=6, max_size=6))
def test_quintics_have_the_same_coefficients(numbers):
    out = np.empty(6)
    quintic_to_bernstein(np.array(numbers), out)
    assert out == pytest.approx(bernstein(numbers), abs=ROUNDING)
