"""Measured motions: how closely splines follow them."""

import numpy as np
import pytest

from coupling.measured import fit_motion

TIMES = np.linspace(0, 4, 1000)


def growing(t):
    s, c = np.sin(3.2 * t), np.cos(3.2 * t)
    return t * s, s + 3.2 * t * c, 6.4 * c - 10.24 * t * s


def largest_errors(drive):
    between = np.linspace(0, 4, 7777)[:-1]
    return [np.abs(f - e).max() for f, e in zip(drive.evaluate(between), growing(between), strict=True)]


def test_a_smooth_motion_is_met_at_every_sample_and_between_them():
    drive, fit = fit_motion("x", TIMES, growing(TIMES)[0])
    assert fit.axis == "x"
    assert fit.rms <= fit.largest < 1e-13
    height, velocity, acceleration = largest_errors(drive)
    assert height < 1e-11 and velocity < 1e-8 and acceleration < 1e-5


def test_a_quintic_at_uneven_times_is_met_exactly():
    times = np.array([0.0, 0.1, 0.4, 0.5, 0.9, 1.3, 1.4, 2.0])
    drive, fit = fit_motion("z", times, 3 - times + times**5)
    assert fit.largest < 5e-15 * 33  # the largest height, of which that is rounding
    fine = np.linspace(0, 1.99, 50)
    assert drive.evaluate(fine)[2] == pytest.approx(20 * fine**3, abs=1e-9)


def test_noise_is_smoothed_to_about_its_own_size():
    noise = 1e-4
    measured = growing(TIMES)[0] + np.random.default_rng(5).normal(0, noise, len(TIMES))
    rough, exact = fit_motion("x", TIMES, measured)
    smooth, fit = fit_motion("x", TIMES, measured, noise)
    assert exact.largest < 1e-12
    assert fit.rms == pytest.approx(noise, rel=0.05)
    assert noise < fit.largest < 5 * noise
    height, _, acceleration = largest_errors(smooth)
    assert height < 2 * noise and acceleration < 2.0  # of 41 m/s^2
    assert largest_errors(rough)[2] > 20.0
    assert len(smooth.times) < 0.1 * len(rough.times)


def test_the_pieces_of_a_spline_are_smooth_to_the_second_derivative():
    drive, _ = fit_motion("x", TIMES, growing(TIMES)[0], 1e-3)
    inner = drive.times[1:-1]
    for before, after in zip(drive.evaluate(inner - 1e-9), drive.evaluate(inner + 1e-9), strict=True):
        assert before == pytest.approx(after, abs=1e-6)


def test_too_little_noise_gives_what_there_is():
    """The residual, not a warning, says how close it came."""
    measured = growing(TIMES)[0] + np.random.default_rng(5).normal(0, 1e-3, len(TIMES))
    _, fit = fit_motion("x", TIMES, measured, 1e-12)
    assert fit.rms < 1e-9
