"""Many paths at a time: the same as one by one, and they can be stopped."""

import _thread
import threading

import numpy as np
import pytest

from coupling.surface import surface_motion
from fem_plate.analytic import DiscShapes
from particle import ConstantFriction, Drive, Interrupted, KogutEtsion, Micropart, simulate, simulate_many

RADIUS, MASS = 300e-6, 2e-9
LAW = ConstantFriction(4e-9)


def drives(rng, count):
    return [Drive(6e-6, float(f), delay=float(d)) for f, d in rng.uniform([900, 0], [1100, 1e-3], (count, 2))]


@pytest.fixture
def surface():
    """Thirteen actuators, so that cells are built where parts come to."""
    x = np.linspace(-0.5, 0.5, 4)
    points = np.concatenate([np.stack(np.meshgrid(x[:3], x), -1).reshape(-1, 2), [[0.62, 0.1]]]) * RADIUS
    return surface_motion(DiscShapes(points, RADIUS), drives(np.random.default_rng(0), len(points)))


@pytest.fixture
def parts():
    places = np.random.default_rng(1).uniform(-0.5, 0.5, (6, 2)) * RADIUS
    return [Micropart(MASS, (x, y)) for x, y in places.tolist()]


def same(one, other):
    return all(
        np.array_equal(getattr(one, name), getattr(other, name)) for name in ("time", "position", "velocity", "state")
    ) and (one.events, one.outcome, one.evaluations) == (other.events, other.outcome, other.evaluations)


def test_paths_have_the_same_bits_one_by_one_and_in_any_order_and_number_of_threads(surface, parts):
    run = {"duration": 3e-3, "tolerance": 1e-6}
    alone = [simulate(surface, part, LAW, **run) for part in parts]
    fresh = surface_motion(surface.store.shapes, drives(np.random.default_rng(0), 13))
    backwards = simulate_many(fresh, parts[::-1], LAW, threads=2, **run)[::-1]
    together = simulate_many(surface, parts, LAW, threads=1, **run)
    assert any(len(path.events) > 3 for path in alone)
    for one, other, third in zip(alone, backwards, together, strict=True):
        assert same(one, other) and same(one, third)


def test_each_path_may_have_its_own_drives_and_friction(surface, parts):
    rng = np.random.default_rng(2)
    own, laws = [drives(rng, 13) for _ in parts], [LAW, KogutEtsion.paper(), LAW] * 2
    found = simulate_many(surface, parts, laws, 2e-3, tolerance=1e-6, drives=own)
    for path, part, law, theirs in zip(found, parts, laws, own, strict=True):
        assert same(path, simulate(surface.driven_by(theirs), part, law, 2e-3, tolerance=1e-6))


def test_progress_ends_with_all(surface, parts):
    seen = []
    simulate_many(surface, parts, LAW, 1e-4, progress=lambda done, count: seen.append((done, count)))
    assert seen[-1] == (6, 6) and seen == sorted(seen)


def test_no_parts_are_no_paths(surface):
    assert simulate_many(surface, [], LAW, 1e-3) == []


def test_every_wrong_input_is_named(surface, parts):
    with pytest.raises(ValueError) as caught:
        simulate_many(
            surface, [parts[0], Micropart(MASS, (1.0, 0.0))], [LAW], -1.0, drives=[[]] * 3, threads=0, tolerance=2.0
        )
    for words in (
        "friction of simulate_many must be one law or one a part, 2; got 1",
        "drives of simulate_many must be one row a part, 2; got 3",
        "threads of simulate_many must be at least 1; got 0",
        "duration",
        "tolerance",
        "position of part 2 must lie on the plate; got (1.0, 0.0) m",
    ):
        assert words in str(caught.value)


def test_drives_of_the_wrong_number_are_refused_before_anything_is_found(surface, parts):
    with pytest.raises(ValueError, match="drives of part 2 must be one an actuator, 13; got 1"):
        simulate_many(surface, parts[:2], LAW, 1e-3, drives=[drives(np.random.default_rng(0), 13), [Drive(1e-6, 300)]])


@pytest.mark.compiled
def test_ctrl_c_keeps_what_is_done(surface, parts):
    """Two parts that are soon done, and two whose paths would take minutes."""
    simulate(surface, parts[0], LAW, 1e-4)
    quick, endless = Micropart(MASS, (0.9 * RADIUS, 0.0)), parts[0]
    started = []

    def progress(done, count):
        if done == 2 and not started:
            started.append(threading.Timer(0.3, _thread.interrupt_main))
            started[0].start()

    laws = [ConstantFriction(1e-3), ConstantFriction(1e-3), LAW, LAW]
    with pytest.raises(Interrupted, match="stopped after 2 of 4 paths") as caught:
        simulate_many(surface, [quick, quick, endless, endless], laws, 30.0, threads=2, progress=progress)
    done = caught.value.found
    assert [path is not None for path in done] == [True, True, False, False]
    assert done[0].time[-1] == 30.0
