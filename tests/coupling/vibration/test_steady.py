"""Steady states: long runs from rest, frequency responses, resonance, and drives that have always been running."""

from dataclasses import replace

import numpy as np
import pytest

from coupling.vibration import Oscillators, always_running, modal_motion
from particle import Drive, Segment, SegmentDrive, TableDrive

F = 1e3  # Hz
RATIO = 0.05
OMEGA = 2 * np.pi * F * np.array([0.9, 1.7, 4.3])
OSCILLATORS = Oscillators(OMEGA, np.full(3, RATIO), np.array([[0.8, -0.3], [-0.5, 0.4], [0.2, 0.7]]))
TABLE = TableDrive(np.array([0.0, 0.1, 0.35, 0.6, 1.0]) / F, np.array([0.0, 1.0, -0.4, 0.3, 0.0]) * 1e-6, repeats=None)
SEGMENTS = SegmentDrive(
    (Segment(1e-6, 2 * F, cycles=2), Segment(cycle="hold", dwell=0.3 / F)), repeats=None, delay=0.2e-3
)
LONG = 150 / F  # e^-(0.05 2 pi 0.9 150) = 4e-19 is left of what began


@pytest.mark.parametrize(
    "drives",
    [
        (Drive(1e-6, F, "sine"), Drive(2e-6, F, "sine", phase=1.1)),
        (Drive(1e-6, F), Drive(-2e-6, F / 2)),
        (Drive(1e-6, F, delay=0.37e-3), Drive(2e-6, F, "cosine", delay=1.6e-3, phase=0.4)),
        (Drive(1e-6, F), Drive(2e-6, F * 2**0.5, "sine")),
        (Drive(1e-6, F, dwell=0.2e-3), Drive(0.0, F)),
        (TABLE, SEGMENTS),
    ],
    ids=["sines", "strokes", "delays", "no common period", "dwell", "table and segments"],
)
def test_the_steady_state_is_what_a_long_run_from_rest_ends_in(drives):
    times = np.random.default_rng(7).uniform(0, 4 / F, 60)
    found = modal_motion(OSCILLATORS, drives, LONG + 5 / F).evaluate(LONG + times)
    early = [replace(drive, delay=(drive.delay - LONG) % drive.segments().span) for drive in drives]
    always = [always_running(drive) for drive in early]
    steady = modal_motion(OSCILLATORS, always, 5 / F, steady=True).evaluate(times)
    assert (np.abs(found - steady).max(axis=(1, 2)) < 1e-9 * np.abs(steady).max(axis=(1, 2))).all()


@pytest.mark.parametrize("share", [0.13, 0.9, 1.0, 1.1, 3.1])
@pytest.mark.parametrize("ratio", [0.05, 1e-4, 0.0])
def test_a_steady_sine_is_the_frequency_response(share, ratio):
    """In amplitude and phase, at resonance too: -m h'' over omega^2 - w^2 + 2 i zeta omega w."""
    if ratio == 0 and share == 1:
        return  # refused, below
    omega, drive = OMEGA[:1], Drive(1e-6, share * OMEGA[0] / (2 * np.pi), "sine", phase=0.3)
    oscillator = Oscillators(omega, np.full(1, ratio), np.array([[0.8]]))
    always = [always_running(drive)]
    times = np.random.default_rng(8).uniform(0, 2 / drive.frequency, 50)
    found = modal_motion(oscillator, always, 3 / drive.frequency, steady=True).evaluate(times)[0, :, 0]
    w = 2 * np.pi * drive.frequency
    answer = 0.8e-6 * w**2 / (omega[0] ** 2 - w**2 + 2j * ratio * omega[0] * w)
    truth = (answer * np.exp(1j * (w * times + 0.3))).imag
    assert np.abs(found - truth).max() < 100 * drive.error * np.abs(answer)


def test_an_undamped_mode_that_resonates_is_refused():
    free = OSCILLATORS._replace(damping=np.zeros(3))
    for frequency in OMEGA[1] / (2 * np.pi) / np.array([1, 2, 3]):
        drives = [always_running(Drive(1e-6, frequency)), always_running(Drive(0.0, F))]
        with pytest.raises(
            ValueError, match=r'"steady" where a mode without damping resonates, as that of 1.7 kHz does'
        ):
            modal_motion(free, drives, 1e-3, steady=True)


def test_an_undamped_plate_off_resonance_has_a_steady_state():
    """What repeats with the drive, though nothing decays towards it."""
    free = OSCILLATORS._replace(damping=np.zeros(3))
    drives = [always_running(Drive(1e-6, 1.2 * F)), always_running(Drive(0.0, F))]
    times = np.random.default_rng(9).uniform(0, 1 / F, 30)
    motion = modal_motion(free, drives, 60 / F, steady=True)
    assert motion.loop >= 0
    damped = modal_motion(OSCILLATORS._replace(damping=np.full(3, 1e-6)), drives, 60 / F, steady=True)
    assert damped.evaluate(times)[0] == pytest.approx(motion.evaluate(times)[0], rel=1e-3, abs=1e-12)
    periods = 50 / (1.2 * F)
    assert motion.evaluate(times + periods)[0] == pytest.approx(motion.evaluate(times)[0], rel=1e-9, abs=1e-17)


def test_a_drive_that_always_runs_is_shifted_by_its_delay():
    drive = Drive(1e-6, F, "cosine", delay=2.3e-3)
    times = np.linspace(0, 3e-3, 61)
    truth = 0.5e-6 * (1 - np.cos(2 * np.pi * F * (times - 2.3e-3)))
    assert always_running(drive).evaluate(times)[0] == pytest.approx(truth, abs=1e-12)
    assert always_running(SEGMENTS).evaluate(times)[0] == pytest.approx(SEGMENTS.evaluate(times + 5.2e-3)[0], abs=1e-18)
    resting = Drive(0.0, F, delay=1e-3)
    assert always_running(resting) is resting


@pytest.mark.parametrize("drive", [Drive(1e-6, F, cycles=3), Drive(1e-6, F, "up"), replace(TABLE, repeats=2)])
def test_a_drive_that_ends_never_always_runs(drive):
    with pytest.raises(ValueError, match='must not be "steady" with a drive that ends'):
        always_running(drive)
