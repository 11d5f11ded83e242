"""Plates that vibrate, against exact radial series, which share nothing with the code but the drives.

The series are those of `radial_vibration`; printed figures are of another implementation of the same.
"""

import numpy as np
import pytest
from radial_vibration import FORCE, Piece, RadialDisc, Wave, strokes
from vibrating_discs import (
    CENTRE,
    DISC,
    FIRST,
    NU,
    RADIUS,
    RIGIDITY,
    UNIT,
    R,
    case_of,
    off,
    on_radii,
    up_down,
)

from coupling import build_surface
from coupling.case import ActuatorCase
from coupling.run import build_scene

pytestmark = pytest.mark.compiled


@pytest.fixture(scope="module")
def surface():
    return build_surface(case_of(up_down(20e3), 300e-6))


@pytest.mark.parametrize(
    "time, w, w_tt",
    [
        (65e-6, [0.4733790863e-6, 0.1859365804e-6], [-2915.6034, -960.2030]),
        (257.5e-6, [0.1126787061e-6, 0.0440651898e-6], [5958.3828, 2497.8467]),
    ],
)
def test_printed_figures(surface, time, w, w_tt):
    state = surface.evaluate(on_radii(), time)
    assert state.w == pytest.approx(w, rel=1e-6)
    assert state.w_tt == pytest.approx(w_tt, rel=1e-4)
    own = DISC.motion(strokes(1e-6, 20e3, 6), R, time, UNIT, 0.02)
    assert own[0] == pytest.approx(w, rel=1e-9) and own[2] == pytest.approx(w_tt, rel=1e-7)


@pytest.mark.slow
@pytest.mark.parametrize("share, cycles", [(0.2, 8), (0.95, 20)])
def test_strokes_near_the_first_frequency(share, cycles):
    end = cycles / (share * FIRST)
    surface = build_surface(case_of(up_down(share * FIRST), end))
    times = np.random.default_rng(1).uniform(0, end, 25)
    in_w, in_w_tt = off(surface, strokes(1e-6, share * FIRST, cycles + 1), times, radii=np.array([0.15, 0.3, 0.6, 0.8]))
    assert in_w < 1e-5 and in_w_tt < 1e-3


@pytest.mark.slow
def test_a_clamped_disc_under_a_force_moves_as_its_series():
    exact = RadialDisc("clamped", NU, FORCE)
    frequency = 0.3 * exact.k[0] ** 2 * UNIT / (2 * np.pi)
    surface = build_surface(case_of(ActuatorCase(position=CENTRE, force=1e-3, frequency=frequency), 4 / frequency))
    pieces = strokes(1e-3 * RADIUS**2 / RIGIDITY, frequency, 5)
    times = np.random.default_rng(2).uniform(0, 4 / frequency, 20)
    in_w, in_w_tt = off(surface, pieces, times, exact)
    assert in_w < 1e-5 and in_w_tt < 1e-3


@pytest.mark.slow
def test_a_disc_on_a_spring_moves_as_its_series():
    exact = RadialDisc("clamped", NU, 40.0)
    frequency, stiffness = 0.3 * exact.k[0] ** 2 * UNIT / (2 * np.pi), 40.0 * RIGIDITY / RADIUS**2
    surface = build_surface(case_of(up_down(frequency, stiffness=stiffness), 4 / frequency))
    times = np.random.default_rng(2).uniform(0, 4 / frequency, 20)
    in_w, in_w_tt = off(surface, strokes(1e-6, frequency, 5), times, exact)
    assert in_w < 1e-5 and in_w_tt < 1e-3


@pytest.mark.slow
def test_without_haste_the_plate_is_quasi_static():
    """Its modes' heights fall as f^2, down to rounding of a stroke, and then the surface is the one without inertia."""
    heights, shares, times = [], np.array([1e-2, 1e-3, 1e-4, 1e-8]), np.linspace(0, 1, 101)
    for share in shares:
        scene = build_scene(case_of(up_down(share * FIRST), 1 / (share * FIRST), {"cell_size": 60e-6}))
        drive = scene.vibration.modal_drives[0]
        heights.append(np.abs(drive.evaluate(times / (share * FIRST))[0]).max() / 1e-6)
    assert heights[:3] / shares[:3] ** 2 == pytest.approx([heights[2] / shares[2] ** 2] * 3, rel=0.05)
    assert heights[3] < 1e-15
    static = build_surface(case_of(up_down(share * FIRST), 1 / (share * FIRST), {"cell_size": 60e-6, "inertia": False}))
    for time in times[1::17] / (share * FIRST):
        moving, resting = scene.surface.evaluate(on_radii(), time), static.evaluate(on_radii(), time)
        assert np.abs(moving.w - resting.w).max() < 1e-13 * 1e-6
        assert moving.w_tt == pytest.approx(resting.w_tt, rel=1e-6)


@pytest.mark.slow
def test_a_jump_of_velocity_sends_out_waves():
    """A sine after a delay: w is continuous and its series converges; the summary says that w_tt's does not."""
    frequency, delay = 0.3 * FIRST, 2e-6
    end = delay + 1 / frequency
    drive = up_down(frequency, cycle="sine", delay=delay)
    scene = build_scene(case_of(drive, end, {"cell_size": 60e-6}))
    surface = scene.surface
    pieces = [Piece(0.0, delay, (0.0,)), Wave(delay, np.inf, 1e-6, 2 * np.pi * frequency)]
    times = np.random.default_rng(3).uniform(delay, end, 20)
    in_w, _ = off(surface, pieces, times, RadialDisc(count=400))
    assert in_w < 1e-4
    before, after = (surface.evaluate(on_radii(), delay + step).w for step in (-1e-13, 1e-13))
    assert np.abs(after - before).max() < 1e-6 * 1e-6
    assert scene.vibration.model.chosen.error > 0.1


@pytest.mark.slow
def test_a_jump_of_acceleration_rings():
    """A cosine after a delay: its acceleration jumps, and that of the plate converges slowly, unlike its height."""
    frequency, delay, half = 0.3 * FIRST, 1e-6, 0.5e-6
    end = delay + 1 / frequency
    drive = up_down(frequency, cycle="cosine", delay=delay)
    scene = build_scene(case_of(drive, end, {"cell_size": 60e-6}))
    pieces = [Piece(0.0, delay, (-half,)), Wave(delay, np.inf, half, 2 * np.pi * frequency, -np.pi / 2)]
    times, exact = np.random.default_rng(4).uniform(delay, end, 20), RadialDisc(count=400)
    found = np.array([scene.surface.evaluate(on_radii(), time).w for time in times])
    truth = np.array([exact.motion(pieces, R, time, UNIT, 0.02)[0] for time in times])
    truth += half * exact.phi(R)  # the constant part moves no mass
    assert np.abs(found - truth).max() < 1e-5 * np.abs(truth).max()
    assert scene.vibration.model.chosen.error > 1e-3
