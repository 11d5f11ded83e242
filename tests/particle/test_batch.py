"""Many paths at a time: the same as one by one, and they can be stopped."""

import _thread
import threading
import weakref
from concurrent.futures import ThreadPoolExecutor, wait

import numpy as np
import pytest

from coupling.surface.motion import surface_motion
from fem_plate.analytic import DiscShapes
from particle import (
    ConstantFriction,
    Drive,
    Interrupted,
    KogutEtsion,
    Micropart,
    platform_surface,
    simulate,
    simulate_many,
)

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


@pytest.fixture
def submitted(monkeypatch):
    """The paths handed out so far."""
    futures, submit = [], ThreadPoolExecutor.submit

    def listed(pool, *call):
        futures.append(submit(pool, *call))
        return futures[-1]

    monkeypatch.setattr(ThreadPoolExecutor, "submit", listed)
    return futures


def same_samples(one, other):
    times = np.linspace(0, one.time[-1], 41)
    return all(np.array_equal(a, b) for a, b in zip(one.at(times), other.at(times), strict=True))


def same(one, other):
    return (
        all(
            np.array_equal(getattr(one, name), getattr(other, name))
            for name in ("time", "position", "velocity", "state")
        )
        and same_samples(one, other)
        and (one.events, one.outcome, one.evaluations) == (other.events, other.outcome, other.evaluations)
    )


@pytest.mark.compiled
def test_paths_have_the_same_bits_one_by_one_and_in_any_order_and_number_of_threads(surface, parts):
    run = {"duration": 3e-3, "tolerance": 1e-6}
    alone = [simulate(surface, part, LAW, **run) for part in parts]
    fresh = surface_motion(surface.store.shapes, drives(np.random.default_rng(0), 13))
    backwards = simulate_many(fresh, parts[::-1], LAW, threads=2, **run)[::-1]
    together = simulate_many(surface, parts, LAW, threads=1, **run)
    assert any(len(path.events) > 3 for path in alone)
    for one, other, third in zip(alone, backwards, together, strict=True):
        assert same(one, other) and same(one, third)


def test_samples_have_the_same_bits_whatever_cells_are_built_after_the_path(surface, parts):
    path = simulate(surface, parts[0], LAW, 3e-3, tolerance=1e-6)
    times = np.linspace(0, 3e-3, 100)
    before, cells = path.at(times), len(surface.store.cells.cell)
    surface.store.build(np.random.default_rng(3).uniform(-0.6, 0.6, (100, 2)) * RADIUS)
    assert len(surface.store.cells.cell) > cells
    for one, other in zip(before, path.at(times), strict=True):
        assert np.array_equal(one, other)


@pytest.mark.parametrize(("scheme", "step"), [("events", None), ("fixed", 1e-6)])
def test_a_path_keeps_no_copy_of_the_cells(surface, parts, scheme, step):
    path = simulate(surface, parts[0], LAW, 1e-4, tolerance=1e-6, scheme=scheme, time_step=step)
    then = weakref.ref(surface.store.cells.roots)
    surface.store.build(np.array([[-0.6, -0.6], [0.6, 0.6]]) * RADIUS)
    assert then() is None and path.at([5e-5]).time[0] == 5e-5


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


def test_an_error_on_the_way_ends_all_paths(surface, parts, monkeypatch):
    def failed(driven, request, tolerance, stop, face):
        raise RuntimeError("no such cell")

    monkeypatch.setattr("particle.simulation.find_path", failed)
    with pytest.raises(RuntimeError, match="^no such cell$"):
        simulate_many(surface, parts, LAW, 1e-4, threads=2)


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
        "position of part 1 must lie on the plate; got (1.0, 0.0) m",
    ):
        assert words in str(caught.value)


@pytest.mark.parametrize("many", [tuple, iter, lambda laws: np.array(laws, dtype=object)])
def test_laws_may_come_as_anything_that_has_one_a_part(surface, parts, many):
    laws = [LAW, KogutEtsion.paper()]
    found = simulate_many(surface, parts[:2], many(laws), 1e-4)
    for path, part, law in zip(found, parts, laws, strict=False):
        assert same(path, simulate(surface, part, law, 1e-4))


@pytest.mark.parametrize(
    "wrong, words",
    [
        (4e-9, "^Input friction of simulate_many must be one law or one a part, 2; got 4e-09$"),
        (None, "^Input friction of simulate_many must be one law or one a part, 2; got None$"),
        ([LAW, 4e-9], "^Input friction of part 1 must be a friction law; got 4e-09$"),
        (np.array([None, LAW]), "^Input friction of part 0 must be a friction law; got None$"),
        ([LAW, ConstantFriction], "^Input friction of part 1 must be a friction law; got <class"),
        ([0.1], "a part, 2; got 1; Input friction of part 0 must be a friction law; got 0.1$"),
    ],
)
def test_what_is_no_friction_law_is_refused(surface, parts, wrong, words):
    with pytest.raises(ValueError, match=words):
        simulate_many(surface, parts[:2], wrong, 1e-3)


def test_a_platforms_drives_cannot_be_exchanged():
    platform, own = platform_surface(Drive(1e-3, 3.0), size=1e-3), [Drive(1e-3, 2.0)]
    with pytest.raises(ValueError, match="^Input drives must stay the surface's own: the drives of a platform"):
        platform.driven_by(own)
    many = "^Input drives of part 0 must stay the surface's own: .* exchanged; make a surface with the drives wanted$"
    with pytest.raises(ValueError, match=many):
        simulate_many(platform, [Micropart(MASS, (0.0, 0.0))] * 2, LAW, 1e-3, drives=[own, own])


def test_drives_that_are_no_rows_are_refused(surface, parts):
    with pytest.raises(ValueError, match="drives of part 0 must be one an actuator, 13; got Drive.*part 1 must be one"):
        simulate_many(surface, parts[:2], LAW, 1e-3, drives=[Drive(1e-6, 300)] * 2)


def test_drives_of_the_wrong_number_are_refused_before_anything_is_found(surface, parts):
    with pytest.raises(ValueError, match="drives of part 1 must be one an actuator, 13; got 1"):
        simulate_many(surface, parts[:2], LAW, 1e-3, drives=[drives(np.random.default_rng(0), 13), [Drive(1e-6, 300)]])


def test_ctrl_c_before_all_paths_are_handed_out_keeps_what_is_done(surface, parts, submitted, monkeypatch):
    submit = ThreadPoolExecutor.submit

    def interrupted(pool, *call):
        if len(submitted) == 4:
            wait(submitted)
            raise KeyboardInterrupt
        return submit(pool, *call)

    monkeypatch.setattr(ThreadPoolExecutor, "submit", interrupted)
    with pytest.raises(Interrupted, match="stopped after 4 of 6 paths") as caught:
        simulate_many(surface, parts, LAW, 1e-4, threads=1)
    assert [path is not None for path in caught.value.found] == [True] * 4 + [False] * 2


def test_ctrl_c_keeps_paths_that_nobody_has_heard_of_yet(surface, parts, submitted):
    def progress(done, count):
        wait(submitted)
        raise KeyboardInterrupt

    with pytest.raises(Interrupted, match="stopped after 6 of 6 paths") as caught:
        simulate_many(surface, parts, LAW, 1e-4, threads=1, progress=progress)
    for path, part in zip(caught.value.found, parts, strict=True):
        assert same(path, simulate(surface, part, LAW, 1e-4))


def test_another_ctrl_c_loses_nothing(surface, parts, submitted, monkeypatch):
    shutdown = ThreadPoolExecutor.shutdown

    def interrupted(pool, **how):
        shutdown(pool, **how)
        if "cancel_futures" in how:
            raise KeyboardInterrupt

    def progress(done, count):
        wait(submitted)
        raise KeyboardInterrupt

    monkeypatch.setattr(ThreadPoolExecutor, "shutdown", interrupted)
    with pytest.raises(Interrupted, match="stopped after 6 of 6 paths"):
        simulate_many(surface, parts, LAW, 1e-4, threads=1, progress=progress)


@pytest.mark.slow
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
