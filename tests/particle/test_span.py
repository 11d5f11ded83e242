"""Spans of the cell where the part is: moving on in time is as good as preparing anew, bridges are as good as asked."""

import math

import numpy as np
import pytest

from coupling.surface.motion import surface_motion
from fem_plate.analytic import DiscShapes
from particle import Drive, platform_surface
from particle.drives import next_breakpoint
from particle.surface.at_point import surface_at
from particle.surface.bridge import allow_bridges
from particle.surface.cells import NOWHERE, UNBUILT
from particle.surface.local import cell_at, missing_place, new_local
from particle.surface.span import enter

RADIUS, STROKE = 300e-6, 10e-6


def spread(count, seed=3):
    """Sunflower places, and strokes of very different frequencies, some of which end."""
    k, rng = np.arange(count) + 0.5, np.random.default_rng(seed)
    points = 0.7 * RADIUS * np.sqrt(k / count)[:, None] * np.stack([np.cos(2.4 * k), np.sin(2.4 * k)], axis=1)
    drives = [
        Drive(STROKE, float(f), cycles=3 if i % 4 == 0 else None, delay=float(d))
        for i, (f, d) in enumerate(zip(rng.uniform(30, 900, count), rng.uniform(0, 1e-3, count), strict=True))
    ]
    return surface_motion(DiscShapes(points, RADIUS), drives)


def values(local, x, y, time):
    f = surface_at(local, x, y, time)
    return np.array([f.w, f.w_t / 1e3, f.w_tt / 1e6, f.w_x * RADIUS, f.w_y * RADIUS, f.w_xy * RADIUS**2])


@pytest.mark.parametrize("count", [1, 3, 12])
def test_after_many_breakpoints_it_is_as_if_prepared_anew(count):
    surface = spread(count)
    x, y = 0.31 * RADIUS, 0.9 * RADIUS  # beside the rim, where w is small against what it is made of
    surface.evaluate([[x, y]], 0.0)
    record, time, breakpoints = surface.record, 0.0, 0
    local = new_local(record)
    while time < 0.05:
        assert enter(record, local, x, y, time, 0.05) >= 0
        anew = new_local(record)
        enter(record, anew, x, y, time, 0.05)
        assert local.frame[0].end == anew.frame[0].end > time
        for share in (0.0, 0.5, 1.0):
            at = time + share * (local.frame[0].end - time)
            assert np.abs(values(local, x, y, at) - values(anew, x, y, at)).max() < 1e-11 * STROKE
        time, breakpoints = local.frame[0].end, breakpoints + 1
    assert breakpoints > 4 * count


def test_a_place_without_a_cell_is_told_and_what_was_prepared_stays():
    surface = spread(12)
    record, local = surface.record, new_local(surface.record)
    x, y = 0.2 * RADIUS, 0.1 * RADIUS
    assert cell_at(record.cells, x, y) == UNBUILT
    assert enter(record, local, x, y, 0.0, 1.0) == UNBUILT
    assert missing_place(local).tolist() == [[x, y]]
    surface.store.build(missing_place(local))
    assert cell_at(record.cells, x, y) == UNBUILT  # what was handed out does not change
    record = surface.record
    local = new_local(record)
    cell = enter(record, local, x, y, 0.0, 1.0)
    assert cell >= 0
    before = local.smooth.copy()
    assert enter(record, local, 2 * RADIUS, 0.0, 0.5e-3, 1.0) == NOWHERE
    assert np.array_equal(local.smooth, before)


def test_a_base_moves_on_as_well():
    drive = Drive(STROKE, 300.0)
    record = platform_surface(drive, Drive(STROKE, 170.0), Drive(STROKE, 90.0), size=STROKE).record
    local, time = new_local(record), 0.0
    while time < 0.05:
        enter(record, local, 0.0, 0.0, time, 0.05)
        middle = 0.5 * (time + local.frame[0].end)
        f = surface_at(local, 0.0, 0.0, middle)
        h, v, a = drive.evaluate(middle)
        assert f.base_px == pytest.approx(h, abs=1e-12 * STROKE)
        assert f.base_vx == pytest.approx(v, abs=1e-9 * STROKE)
        assert f.base_ax == pytest.approx(a, abs=1e-6 * STROKE)
        time = local.frame[0].end
    assert math.isclose(time, 0.05)


@pytest.mark.compiled
@pytest.mark.parametrize("end", [0.005, pytest.param(0.02, marks=pytest.mark.slow)])
@pytest.mark.parametrize("off", [1e-3, 1e-5])
def test_bridges_are_as_good_as_asked_and_meet_the_surface_at_both_ends(off, end):
    surface, (x, y) = spread(100), (0.31 * RADIUS, 0.2 * RADIUS)
    surface.evaluate([[x, y]], 0.0)
    record = surface.record
    velocity, acceleration = off * STROKE * 1e3, 10 * off * STROKE * 1e6
    exact, bridged, time, breakpoints, spans = new_local(record), new_local(record), 0.0, 0, 0
    allow_bridges(bridged, velocity, acceleration)
    rng = np.random.default_rng(0)
    while time < end:
        assert enter(record, bridged, x, y, time, end) >= 0
        frame = bridged.frame[0]
        until, spans = frame.end, spans + 1
        begin = time
        while time < until:
            enter(record, exact, x, y, time, until)
            breakpoints += 1
            for at in (time, 0.5 * (time + exact.frame[0].end), exact.frame[0].end):
                u, v = rng.uniform(-1, 1, 2) * [frame.half_x, frame.half_y]
                place = frame.x + u, frame.y + v
                one, other = surface_at(exact, *place, at), surface_at(bridged, *place, at)
                share = 0.01 if at in (begin, until) else 1.0  # what rounding makes of the shortest bridges
                assert abs(one.w_t - other.w_t) < share * velocity
                assert abs(one.w_tt - other.w_tt) < share * acceleration
            time = exact.frame[0].end
    assert time == end
    assert spans < {1e-3: 0.35, 1e-5: 0.8}[off] * breakpoints


def test_only_what_hardly_counts_is_bridged():
    """Over two actuators every breakpoint ends a span, whatever is allowed short of the motion itself."""
    surface = spread(2)
    record = surface.record
    local, time = new_local(record), 0.0
    allow_bridges(local, 1e-4 * STROKE * 1e3, 1e-3 * STROKE * 1e6)
    while time < 0.05:
        enter(record, local, 0.0, 0.0, time, 0.05)
        assert local.frame[0].end == min(next_breakpoint(record.drives, time), 0.05)
        time = local.frame[0].end
