"""A measured friction law: through its points, smooth, never falling, and what is refused."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from particle import CoulombAdhesion, FrictionTable, KogutEtsion, Micropart, Outcome, polynomial_surface, simulate
from particle.friction.contact import friction_limit

LOADS, LIMITS = (-2e-6, -1e-6, 0.0, 3e-6, 1e-5), (0.0, 4e-8, 4e-8, 9e-8, 1.2e-7)


@pytest.fixture
def table():
    return FrictionTable(LOADS, LIMITS)


def test_it_goes_through_its_points(table):
    assert table.friction_limit(LOADS) == pytest.approx(LIMITS, rel=1e-14, abs=0)
    assert (table.pull_off, table.largest_load) == (2e-6, 1e-5)


def test_it_takes_arrays_and_is_comparable(table):
    assert FrictionTable(np.array(LOADS), np.array(LIMITS)) == table
    assert hash(FrictionTable(list(LOADS), list(LIMITS))) == hash(table)


@settings(deadline=None, max_examples=60)
@given(st.lists(st.tuples(st.floats(1e-3, 1.0), st.just(0.0) | st.floats(0.0, 1.0)), min_size=2, max_size=12))
def test_it_never_falls(steps):
    loads, limits = np.cumsum([(-0.5, 0.1), *steps], axis=0).T
    table = FrictionTable(loads, limits)
    limit = table.friction_limit(np.linspace(loads[0], loads[-1], 2001))
    assert np.diff(limit).min() >= -1e-13 * limits[-1]


def test_value_slope_and_second_derivative_meet_at_every_point(table):
    law = table.law
    h = np.diff(LOADS)
    for order in range(3):
        for k in range(1, len(LOADS) - 1):
            end = np.polyval(np.polyder(law.pieces[:, k], order), h[k - 1])
            begin = np.polyval(np.polyder(law.pieces[:, k + 1], order), 0.0)
            assert end == pytest.approx(begin, rel=1e-9, abs=1e-9 * LIMITS[-1] / h.min() ** order)


def test_where_the_points_are_level_the_limit_is_constant(table):
    between = table.friction_limit(np.linspace(-1e-6, 0.0, 101))
    assert between == pytest.approx(np.full(101, 4e-8), rel=1e-14)


def test_points_of_a_line_give_the_line():
    line = CoulombAdhesion(0.3, adhesion=1e-6)
    loads = [-1e-6, 0.0, 5e-7, 4e-6, 5e-6]
    table = FrictionTable(loads, line.friction_limit(loads))
    between = np.linspace(-1e-6, 5e-6, 301)
    assert table.friction_limit(between) == pytest.approx(line.friction_limit(between), rel=1e-12, abs=1e-20)
    assert table.table_error < 1e-14


def test_finer_points_of_a_smooth_law_converge_at_fourth_order_and_the_stated_error_holds():
    errors, stated = [], []
    for count in (17, 33, 65):
        loads = np.linspace(-2e-6, 5e-6, count)
        between = np.linspace(-2e-6, 5e-6, 2001)

        def law(load):
            return 1e-7 * (1.2 + np.tanh(load / 1e-6))

        table = FrictionTable(loads, law(loads))
        errors.append(np.abs(table.friction_limit(between) / law(between) - 1).max())
        stated.append(table.table_error)
    assert np.log2(np.divide(errors[:-1], errors[1:])).min() > 3.5 and errors[-1] < 1e-5
    assert (np.array(errors) < stated).all()


def test_a_table_of_another_law_gives_its_friction():
    contact = KogutEtsion.paper()
    loads = contact.pull_off * (np.linspace(0, 1.6, 200) ** 2 - 1)  # dense where the law is steep
    table = FrictionTable(loads, contact.friction_limit(loads))
    between = contact.pull_off * np.linspace(-0.999, 1.5, 500)
    assert table.friction_limit(between) == pytest.approx(contact.friction_limit(between), rel=1e-5)


def test_beyond_its_ends_the_kernel_goes_on_and_the_law_refuses(table):
    law = table.law
    assert friction_limit(law, -2.5e-6) == 0.0
    assert friction_limit(law, 1.1e-5) >= LIMITS[-1]
    for load in (-2.1e-6, 1.1e-5):
        with pytest.raises(ValueError, match="^Input net_load must be at (least|most) .*; got "):
            table.friction_limit(load)


def test_a_static_ratio_is_kept(table):
    assert FrictionTable(LOADS, LIMITS, 1.5).law.static_ratio == 1.5
    assert table.law.static_ratio == 1.0


@pytest.mark.parametrize(
    "loads, limits, ratio, says",
    [
        ([-1.0, 0.0], [0.0, 1.0], 1.0, ["loads of FrictionTable must be 3 forces in N or more; got 2"]),
        (LOADS, LIMITS[1:], 1.0, ["limits of FrictionTable must be as many as the loads, 5; got 4"]),
        ([0.5, 1.0, 2.0], [0, 1, 2], 1.0, ["loads of FrictionTable at point 0 must be minus the pull-off force"]),
        ([-1, 1, 1], [0, 1, 2], 1.0, ["loads of FrictionTable at point 2 must be greater than the one before, 1.0 N"]),
        (
            [-1, 1, 2],
            [1, 0, 2],
            1.0,
            ["limits of FrictionTable at point 1 must not be less than the one before, 1.0 N"],
        ),
        (
            [-1.0, math.nan, math.inf],
            [-1.0, math.nan, 1.0],
            0.9,
            [
                "loads of FrictionTable at point 1 must be finite; got nan",
                "loads of FrictionTable at point 2 must be finite; got inf",
                "limits of FrictionTable at point 0 must be 0 or positive; got -1.0 N",
                "limits of FrictionTable at point 1 must be finite; got nan",
                "static_ratio of FrictionTable must be at least 1; got 0.9",
            ],
        ),
    ],
)
def test_everything_that_is_wrong_is_told_at_once(loads, limits, ratio, says):
    with pytest.raises(ValueError) as caught:
        FrictionTable(loads, limits, ratio)
    messages = str(caught.value).split("; Input ")
    assert len(messages) == len(says)
    for message, said in zip(messages, says, strict=True):
        assert message.removeprefix("Input ").startswith(said)


SLOPE = 0.5
LINE = CoulombAdhesion(0.3, adhesion=2.0)
STEEP = FrictionTable((-2.0, 0.0, 4.0, 12.0), LINE.friction_limit([-2.0, 0.0, 4.0, 12.0]))


def end(law, gravity=9.81):
    """A part of 1 kg after 0.3 s on an incline."""
    return simulate(polynomial_surface([[0.0], [SLOPE]]), Micropart(1.0, (0.0, 0.0)), law, 0.3, gravity=gravity)


def test_a_run_on_a_table_of_a_line_is_the_run_on_the_line():
    table, line = end(STEEP), end(LINE)
    assert line.position[-1, 0] < -0.01
    assert table.position[-1] == pytest.approx(line.position[-1], rel=1e-9)
    assert table.friction_force[-1] == pytest.approx(line.friction_force[-1], rel=1e-9)


def test_a_run_holds_a_stuck_part_by_the_static_ratio():
    # It slides from a friction of 4.39 N, Q = 3.23 N.
    assert end(STEEP).outcome is Outcome.MOVING
    assert end(FrictionTable(STEEP.loads, STEEP.limits, static_ratio=1.5)).outcome is Outcome.STUCK


def test_a_run_ends_where_the_table_ends():
    assert end(STEEP, gravity=14.0).outcome is Outcome.OVERLOADED
    assert end(STEEP, gravity=-2.5).outcome is Outcome.DETACHED
