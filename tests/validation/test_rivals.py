"""The rivals that the integrator is timed against solve the same equations: their pieces agree with the product's."""

import contact as contacts
import numpy as np
import paths
import pytest
from rivals import neighbours, ours, tables, with_numba, with_numpy, with_scipy
from rivals.compare import COMPILED, JAX, LOOP, OURS, SCIPY, TARGETS, Comparison, Row, cheapest
from rivals.problem import RADIUS, STARTS, problem, sunflower

from particle import Drive, Micropart, simulate

pytestmark = pytest.mark.slow
STEPS = 60


@pytest.fixture(scope="module")
def pair():
    return problem(2, STARTS[2], duration=1.5e-3)


@pytest.fixture(scope="module")
def rough():
    return problem(2, STARTS[2], duration=1.5e-3, rough=True)


@pytest.fixture(scope="module")
def surface(pair):
    return ours.surface_of(pair)


def test_forces_are_those_of_the_drives(pair):
    for time in (0.0, 2e-4, 7e-4, 1.4e-3):
        span = np.searchsorted(pair.breakpoints[1:-1], time, side="right")
        found = pair.forces[span] @ with_numpy.powers(time - pair.breakpoints[span])
        drives = [
            Drive(pair.stroke, f, delay=d).evaluate(time) for f, d in zip(pair.frequencies, pair.delays, strict=True)
        ]
        expected = pair.shapes.strengths @ np.array(drives)
        assert np.abs(found - expected).max(axis=0) == pytest.approx(0, abs=1e-11 * np.abs(found).max())


def test_both_sums_are_the_moving_surface(pair, surface):
    xy, time = RADIUS * np.random.default_rng(0).uniform(-0.5, 0.5, (20, 2)), 1.2e-3
    f, true = with_numpy.plate(xy, time, pair), surface.evaluate(xy, time)
    span = np.searchsorted(pair.breakpoints[1:-1], time, side="right")
    at = np.empty((2, 3))
    with_numba.quintics(pair.forces[span], time - pair.breakpoints[span], at)
    compiled = np.array([with_numba.plate(x, y, pair.points, at) for x, y in xy])
    expected = [true.w_tt, *true.gradient.T, *true.gradient_t.T, *true.hessian.reshape(-1, 4).T[[0, 1, 3]]]
    by_numpy = [f.w_tt, *f.gradient.T, *f.gradient_t.T, *f.hessian.reshape(-1, 4).T[[0, 1, 3]]]
    for mine, *others in zip(expected, by_numpy, compiled.T, strict=True):
        for other in others:
            assert np.abs(other - mine).max() < 1e-8 * np.abs(mine).max()


@pytest.mark.parametrize("contact", ["pair", "rough"])
def test_fixed_steps_are_those_of_the_scheme(contact, surface, request):
    which = request.getfixturevalue(contact)
    step = which.duration / STEPS
    limit = which.friction.friction_limit
    data = (which.points, which.breakpoints, which.forces, which.friction.law, step, STEPS)
    compiled = np.array(with_numba.fixed_steps(*which.start, *data))
    starts = np.array([which.start, (0.0, 0.0), which.start])
    many = with_numpy.fixed_steps(which, starts, limit, step, STEPS)
    scheme = ours.path_of(which, surface)(scheme="fixed", time_step=step).position[-1]
    moved = np.hypot(*(compiled - which.start))
    assert moved > 1e-6
    for other in (many[0], many[2], scheme):
        assert np.hypot(*(other - compiled)) < 1e-9 * moved


def test_the_root_search_is_the_table(rough):
    def root(loads):
        return contacts.solve(rough.friction, loads)

    step, start = rough.duration / 20, np.array([rough.start])
    table, found = (
        with_numpy.fixed_steps(rough, start, limit, step, 20) for limit in (rough.friction.friction_limit, root)
    )
    assert np.hypot(*(found - table)[0]) < 1e-9 * np.hypot(*(table - start)[0])


def test_right_sides_agree(pair, rough):
    state = np.array([60e-6, -40e-6, 3e-3, -5e-3])
    for which in (pair, rough):
        plain, compiled = with_scipy.rate_in_numpy(which), with_scipy.rate_in_numba(which)
        assert compiled(1.2e-3, state) == pytest.approx(plain(1.2e-3, state), rel=1e-10)


@pytest.mark.parametrize("contact", ["pair", "rough"])
def test_scipy_ends_where_the_product_does(contact, surface, request):
    which = request.getfixturevalue(contact)
    path = ours.path_of(which, surface)(tolerance=1e-11)
    assert len(path.events) > 1
    found = with_scipy.trace(which, with_scipy.rate_in_numba(which), 1e-9)
    assert np.hypot(*(found.place - path.position[-1])) < 1e-7 * path.distance


def test_a_part_that_is_held_stays(pair, surface):
    glued = problem(2, (280e-6, 0.0), duration=1.5e-3)
    found = with_scipy.trace(glued, with_scipy.rate_in_numpy(glued), 1e-6)
    path = simulate(surface, Micropart(2e-9, glued.start), glued.friction, glued.duration)
    assert not path.events
    assert found.evaluations == 0 and tuple(found.place) == glued.start


def test_all_neighbours_are_the_surface(pair, surface):
    centre, pitch, time = np.array([20e-6, 30e-6]), 60e-6, 1.2e-3
    xy = centre + neighbours.HALF * pitch * np.array([[0.9, -0.9], [0.0, 0.5], [-1.0, 1.0]])
    of = neighbours.neighbours(pair, centre, pitch, np.arange(2))
    span = np.searchsorted(pair.breakpoints[1:-1], time, side="right")
    drives = np.linalg.solve(pair.shapes.strengths, pair.forces[span])
    found = neighbours.repeat(xy, drives, time - pair.breakpoints[span], of, neighbours.MONOMIALS, 1)
    mine = ours.evaluations(surface, xy, time, 1)
    assert (np.abs(found - mine).max(axis=0) < 1e-5 * np.abs(mine).max(axis=0)).all()


def test_jax_makes_the_same_steps(pair):
    pytest.importorskip("jax")
    from rivals import with_jax

    step = pair.duration / STEPS
    starts = np.array([pair.start, (10e-6, 20e-6)])
    found = with_jax.new_fixed_steps(pair)(starts, step, STEPS)
    expected = with_numpy.fixed_steps(pair, starts, pair.friction.friction_limit, step, STEPS)
    assert np.abs(found - expected).max() < 1e-15


def test_the_cheapest_tolerance_is_not_a_lucky_one():
    errors = {1e-3: (1e-9, 10), 1e-6: (1e-4, 20), 1e-8: (1e-7, 50), 1e-10: (1e-8, 40)}
    assert cheapest(errors, 1e-6) == (1e-10, 40)
    assert cheapest(errors, 1e-3) == (1e-3, 10)
    with pytest.raises(AssertionError, match="tightest is off by 1.0e-08"):
        cheapest(errors, 1e-9)


@pytest.mark.parametrize("count", [1, 2, 1000])
def test_seeds_lie_apart_and_within(count):
    points = sunflower(count)
    assert points.shape == (count, 2)
    assert np.hypot(*points.T).max() < 0.8 * RADIUS
    apart = np.hypot(*(points[:, None] - points).transpose(2, 0, 1)) + RADIUS * np.eye(count)
    assert apart.min() > 1.0 * RADIUS / np.sqrt(count) or count < 3


def test_tables_tell_what_was_not_tried():
    def row(problem, method, ratio, extrapolated=False):
        return Row(problem, 1, TARGETS[0], method, (ratio, ratio / 2, 2 * ratio), 2_500_000, extrapolated)

    rows = [row("1", LOOP, 123.4, True), row("1", JAX, 0.5), row("1, rough", LOOP, 7.0)]
    header, _, *lines = tables.ratios_table(rows)
    assert header == "| error | method | 1 | 1, rough |"
    assert lines[0] == "| 1e-03 | Python loop | 120 (62 - 250) * | 7 (3.5 - 14) |"
    assert lines[1] == f"| 1e-03 | {JAX} | 0.5 (0.25 - 1) | - |"
    assert len(lines) == 2


@pytest.mark.parametrize(("count", "tolerance"), [(25, 1e-6), (100, 1e-9)])
def test_a_breakpoint_of_many_drives_costs_few_evaluations(count, tolerance):
    """About one step of the pair of order 5 each, as the surface at its end serves the next."""
    many = problem(count, STARTS[count], duration=5e-3)
    path = ours.path_of(many, ours.surface_of(many))(tolerance=tolerance)
    assert len(path.events) > 0
    assert path.evaluations < 8.5 * (len(many.breakpoints) - 1)


@pytest.mark.parametrize("counts", [["0"], ["1", "10001"], ["-3"]])
def test_counts_that_make_no_sense_are_refused(counts, monkeypatch, capsys):
    monkeypatch.setattr("sys.argv", ["paths.py", "--counts", *counts])
    with pytest.raises(SystemExit) as end:
        paths.main()
    assert end.value.code == 2
    assert f"from 1 to 10000, up to which all forces fit in memory; got [{counts[-1]}]" in capsys.readouterr().err


def test_one_actuator_by_all():
    rows = list(Comparison(problem(1, STARTS[1])).rows())
    work = {(row.method, row.target): row.work for row in rows}
    assert all(row.ratio[0] == 1 for row in rows if row.method == OURS)
    assert all(row.ratio[1] > 0 for row in rows)
    for target in TARGETS:
        assert work[OURS, target] < work[SCIPY, target]
    # First order: a thousandth of the error takes a thousand times the steps.
    assert work[COMPILED, 1e-9] == pytest.approx(1e3 * work[COMPILED, 1e-6], rel=0.1)
    assert [row.extrapolated for row in rows if row.method == COMPILED] == [False, False, True]
