"""Measured motions: their noise, how smooth they are, and their impacts."""

import numpy as np
import pytest

from coupling.drives import first_jump
from coupling.measured import fit_motion
from coupling.measured.series import Series, smoothed
from particle import CoulombAdhesion, EventKind, Micropart, platform_surface, simulate

pytestmark = pytest.mark.compiled

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


def noisy(noise, seed=5):
    return growing(TIMES)[0] + np.random.default_rng(seed).normal(0, noise, len(TIMES))


def test_noise_is_smoothed_as_the_data_say_or_as_is_named():
    noise = 1e-4
    for smoothing in (None, noise):
        smooth, fit = fit_motion("x", TIMES, noisy(noise), smoothing)
        assert fit.rms == pytest.approx(noise, rel=0.05) and fit.noise == pytest.approx(noise, rel=0.1)
        assert noise < fit.largest < 5 * noise
        assert fit.freedom < 60 and fit.samples == 1000 and fit.named == (smoothing is not None) and not fit.jumps
        height, _, acceleration = largest_errors(smooth)
        assert height < 5 * noise and acceleration < 8.0  # of 41 m/s^2, most at the ends


def test_the_pieces_are_smooth_to_the_second_derivative():
    drive, _ = fit_motion("x", TIMES, noisy(1e-3))
    inner = drive.segments().start[1:]
    for before, after in zip(drive.evaluate(inner - 1e-9), drive.evaluate(inner + 1e-9), strict=True):
        assert before == pytest.approx(after, abs=1e-4)


def test_too_little_noise_gives_what_there_is():
    """The residual, not a warning, says how close it came."""
    measured = growing(TIMES)[0] + np.random.default_rng(5).normal(0, 1e-3, len(TIMES))
    _, fit = fit_motion("x", TIMES, measured, 1e-12)
    assert fit.rms < 1e-9


def test_noise_is_told_from_motion_and_adds_what_the_smoothing_leaves():
    _, smooth = fit_motion("x", TIMES, growing(TIMES)[0])
    assert smooth.noise < 1e-9  # of 4 m
    shaken = []
    inner = np.linspace(0.3, 3.7, 7777)
    for seed in range(5):
        drive, fit = fit_motion("x", TIMES, noisy(1e-4, seed), 0.95e-4)
        assert fit.noise == pytest.approx(1e-4, rel=0.1)
        shaken.append(np.sqrt(np.mean((drive.evaluate(inner)[2] - growing(inner)[2]) ** 2)) / fit.noise_acceleration)
    assert 0.5 < np.median(shaken) < 2.0


def test_the_motion_is_that_of_a_dense_solution():
    """Twelve samples at uneven times and one kick: the mean of a random motion, by one covariance matrix."""
    rng, roughness, kick = np.random.default_rng(0), 0.3, 5.3
    times = np.cumsum(rng.uniform(0.5, 1.5, 12))
    times -= times[0]
    values = rng.normal(0, 3, 12)
    series = Series(times, np.stack([values, *np.full((2, 12), np.nan)], axis=1), np.ones(3), 1.0, 1.0)
    motion = smoothed(series, np.array([[kick, 1.0]]), roughness)
    nodes, weights = np.polynomial.legendre.leggauss(6)
    half = np.minimum.outer(times, times)[..., None] / 2
    moments = half * (1 + nodes)
    powers = ((times[:, None, None] - moments) * (times[:, None] - moments)) ** 4 / 24**2
    inverse = np.linalg.inv(np.eye(12) + roughness * (powers * half * weights).sum(axis=2))
    free = np.column_stack([np.vander(times, 5), np.maximum(0, times - kick)])
    along = inverse @ free
    left = inverse - along @ np.linalg.solve(free.T @ along, along.T)
    assert motion.freedom[0] == pytest.approx(12 - np.trace(left), rel=1e-6)
    assert motion.residuals[:, 0] == pytest.approx(left @ values, abs=1e-5)


def shaken_with_jumps(t, jumps):
    return 1e-3 * np.sin(60 * np.pi * t) + sum(size * np.maximum(0, t - time) for time, size in jumps)


SLIPS, STOPS = EventKind.SLIPS, EventKind.STOPS
JUMPS = ((0.1502, 0.2), (0.2757, -0.25), (0.4011, 0.15))
SAMPLED = np.arange(480) / 960


def test_jumps_of_velocity_are_found_kept_and_followed():
    samples = shaken_with_jumps(SAMPLED, JUMPS) + np.random.default_rng(2).normal(0, 5e-6, len(SAMPLED))
    drive, fit = fit_motion("x", SAMPLED, samples)
    assert [time for time, _ in fit.jumps] == pytest.approx([time for time, _ in JUMPS], abs=3e-4)
    assert [size for _, size in fit.jumps] == pytest.approx([size for _, size in JUMPS], abs=0.02)
    for time, size in fit.jumps:
        before, after = drive.evaluate([time - 1e-9, time + 1e-9])[1]
        assert after - before == pytest.approx(size, rel=1e-3)
        before, after = drive.evaluate([time - 1e-9, time + 1e-9])[0]
        assert after == pytest.approx(before, abs=1e-8)
    assert first_jump([drive], 0.5) == pytest.approx(fit.jumps[0][0])
    assert first_jump([drive], 0.1) is None


@pytest.mark.parametrize("noise", [1e-8, 1e-7, 1e-6])
def test_an_impact_is_placed_between_samples_as_well_as_the_noise_allows(noise):
    times = np.arange(96) / 960
    samples = 0.1 * np.maximum(0, times - 0.0403) + np.random.default_rng(0).normal(0, noise, len(times))
    _, fit = fit_motion("x", times, samples)
    ((moment, jump),) = fit.jumps
    assert moment == pytest.approx(0.0403, abs=20 * noise / 0.1)
    assert jump == pytest.approx(0.1, abs=20 * noise * 960 / 6)


def test_a_squeezed_part_at_rest_slips_at_an_impact_and_stops_by_its_friction():
    """The platform goes off at 0.1 m/s at once: the part is left behind by v^2 / (2 a), a = 0.5 (g + squeeze/mass)."""
    times = np.arange(96) / 960
    noise = np.random.default_rng(0).normal(0, 1e-6, len(times))
    drive, fit = fit_motion("x", times, 0.1 * np.maximum(0, times - 0.04) + noise)
    ((moment, jump),) = fit.jumps
    assert (moment, jump) == pytest.approx((0.04, 0.1), rel=2e-3)
    part = Micropart(mass=2e-9, position=(0.0, 0.0), squeeze=2e-8)
    path = simulate(platform_surface(drive, None, None, 1e-3), part, CoulombAdhesion(0.5), 0.09, tolerance=1e-8)
    slip, stop = (next(e for e in path.events if e.kind is kind and e.time > 0.039) for kind in (SLIPS, STOPS))
    pull = 0.5 * (9.80665 + 10.0)
    assert slip.time == pytest.approx(0.04, abs=1e-4) and stop.time - slip.time == pytest.approx(0.1 / pull, rel=1e-2)
    assert path.position[-1, 0] == pytest.approx(-(0.1**2) / (2 * pull), rel=1e-2)


@pytest.mark.parametrize("noise", [2e-6, 1e-5, 4e-5])
def test_smooth_motions_get_no_jump(noise):
    for seed in range(3):
        rng = np.random.default_rng(seed)
        samples = shaken_with_jumps(SAMPLED, ()) + rng.normal(0, noise, len(SAMPLED))
        assert not fit_motion("x", SAMPLED, samples)[1].jumps


@pytest.mark.parametrize(
    ("frequency", "noise", "seed"),
    [
        (10, 1e-5, 3),
        *(pytest.param(*one, marks=pytest.mark.slow) for one in ((10, 2e-6, 1), (20, 2e-6, 0), (10, 1e-5, 0))),
    ],
)
def test_strokes_up_and_down_are_no_impacts(frequency, noise, seed):
    """The jerk jumps where they meet. With noise each such jump alone looks much as one of velocity."""
    rng = np.random.default_rng(seed)
    times = np.arange(961) / 960
    turn = (times * frequency + rng.uniform(0, 1)) % 1
    up, down = np.clip(2 * turn, 0, 1), np.clip(2 * turn - 1, 0, 1)
    strokes = 1e-3 * (up**3 * (10 - 15 * up + 6 * up**2) - down**3 * (10 - 15 * down + 6 * down**2))
    assert not fit_motion("x", times, strokes + rng.normal(0, noise, len(times)))[1].jumps


def test_velocities_and_accelerations_count_by_their_own_noise():
    rng = np.random.default_rng(4)
    h, v, a = growing(TIMES)
    noises = 1e-3, 1e-3, 0.5
    columns = [column + rng.normal(0, noise, len(TIMES)) for column, noise in zip((h, v, a), noises, strict=True)]
    with_both, fit = fit_motion("x", TIMES, columns[0], None, *columns[1:])
    assert (fit.noise, fit.velocity_noise, fit.acceleration_noise) == pytest.approx(noises, rel=0.1)
    alone, _ = fit_motion("x", TIMES, columns[0])
    assert largest_errors(with_both)[1] < 0.3 * largest_errors(alone)[1]


def test_jitter_and_gaps_in_time_are_taken_as_they_are():
    rng = np.random.default_rng(6)
    times = np.sort(np.concatenate([[0.0, 4.0], rng.uniform(0, 2.0, 500), rng.uniform(2.2, 4.0, 400)]))
    times = times[np.insert(np.diff(times) > 1e-6, 0, True)]
    drive, fit = fit_motion("x", times, growing(times)[0] + rng.normal(0, 1e-4, len(times)))
    assert fit.gaps >= 1 and fit.longest_step == pytest.approx(0.2, abs=0.03) and not fit.jumps
    between = np.linspace(0.1, 3.9, 999)
    assert drive.evaluate(between)[0] == pytest.approx(growing(between)[0], abs=5e-4)


def blown(duration, seed):
    """Noisy samples of a motion at 30 Hz whose velocity rises by .3 m/s in a time [s] of each period; the motion."""
    rng, fine = np.random.default_rng(seed), np.arange(24000) / 48000
    velocity = 0.25 * np.sin(2 * np.pi * 30 * fine + 1.0)
    for start in (np.arange(14) + 0.4 + rng.uniform(-0.02, 0.02, 14)) / 30:
        share = np.clip((fine - start) / max(duration, 1e-9), 0.0, 1.0)
        velocity += 0.3 * (share - np.sin(2 * np.pi * share) / (2 * np.pi))
    velocity -= np.polyval(np.polyfit(fine, velocity, 1), fine)
    return fine[::50], (np.cumsum(velocity) / 48000)[::50] + rng.normal(0, 1e-5, 480), fine, velocity


@pytest.mark.parametrize("seed", [0, pytest.param(1, marks=pytest.mark.slow), pytest.param(2, marks=pytest.mark.slow)])
def test_blows_that_last_some_samples_are_no_impacts_and_sudden_ones_are(seed):
    """Taken for impacts, blows of 4 ms made the velocity 2.4 times as wrong as the smooth motion does."""
    times, positions, fine, velocity = blown(4e-3, seed)
    drive, fit = fit_motion("x", times, positions)
    assert not fit.jumps
    within = fine <= times[-1]
    assert np.sqrt(np.mean((drive.evaluate(fine[within])[1] - velocity[within]) ** 2)) < 0.012
    assert len(fit_motion("x", *blown(0.0, seed)[:2])[1].jumps) >= 12
