"""Oscillators between breakpoints: another integrator, jumps, loops, and the errors of pieces in time."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import coupling.vibration.motion as motion_module
from coupling.stretch import breakpoints
from coupling.vibration import Oscillators, modal_motion
from coupling.vibration.oscillators import lay_edges
from particle import Drive
from particle.drives import drive_table

F = 1e3  # Hz
OSCILLATORS = Oscillators(
    2 * np.pi * F * np.array([0.9, 1.7, 4.3]),
    np.array([0.02, 0.0, 0.3]),
    np.array([[0.8, -0.3], [-0.5, 0.4], [0.2, 0.7]]),
)
STROKES = Drive(1e-6, F), Drive(-2e-6, 0.7 * F, delay=0.2e-3)
JUMPY = Drive(1e-6, F, "cosine", cycles=1, delay=0.13e-3, phase=0.6), Drive(2e-6, 1.3 * F, "sine", delay=0.41e-3)


def integrated(drives, times, jumps):
    """Values and velocities (2, k, n) by scipy, from rest, restarted at breakpoints; jumps: when velocities jump."""
    omega, ratio, m = OSCILLATORS
    n = len(omega)

    def rate(t, y):
        h_tt = np.array([drive.evaluate(t)[2] for drive in drives])
        return np.concatenate([y[n:], -(omega**2) * y[:n] - 2 * ratio * omega * y[n:] - m @ h_tt])

    ends = {times[-1]} | set(jumps)
    for drive in drives:
        pieces = drive.segments()
        span = pieces.since[-1] + pieces.scale[-1]
        for turn in range(1 if np.isfinite(pieces.repeats) and pieces.repeats < 2 else 6):
            ends |= {drive.delay + turn * span + t for t in (*pieces.since, span)}
    ends = sorted(t for t in ends if 0 < t <= times[-1])
    state, begin, found = np.zeros(2 * n), 0.0, np.zeros((2, len(times), n))
    last = np.array([[drive.evaluate(0.0)[0], 0.0] for drive in drives])
    for end in ends:
        inside = 1e-9 * (end - begin)  # at a breakpoint itself, evaluate takes one side
        now = np.array([np.array(drive.evaluate(begin + inside)[:2]) for drive in drives])
        if begin in jumps:
            state[n:] -= m @ (now - last)[:, 1]
        wanted = (times > begin) & (times <= end)
        solved = solve_ivp(
            lambda t, y, a=begin + inside, b=end - inside: rate(min(max(t, a), b), y),
            (begin, end),
            state,
            "DOP853",
            dense_output=True,
            rtol=1e-13,
            atol=1e-22,
        )
        if wanted.any():
            found[:, wanted] = solved.sol(times[wanted]).T.reshape(-1, 2, n).transpose(1, 0, 2)
        state, begin = solved.y[:, -1], end
        last = np.array([np.array(drive.evaluate(end - inside)[:2]) for drive in drives])
    return found


@pytest.mark.parametrize(
    "drives, jumps", [(STROKES, ()), (JUMPY, (0.13e-3, 0.41e-3, 0.13e-3 + 1 / F))], ids=["strokes", "jumps"]
)
def test_oscillators_move_as_another_integrator_has_them(drives, jumps):
    times = np.linspace(0.01e-3, 1.3e-3, 47)
    motion = modal_motion(OSCILLATORS, drives, 1.3e-3)
    found, truth = motion.evaluate(times), integrated(drives, times, jumps)
    for order in range(2):
        assert np.abs(found[order] - truth[order]).max() < 1e-10 * np.abs(truth[order]).max()
    h_tt = np.stack([drive.evaluate(times)[2] for drive in drives], axis=1)
    omega, ratio, m = OSCILLATORS
    residual = found[2] + 2 * ratio * omega * found[1] + omega**2 * found[0] + h_tt @ m.T
    assert np.abs(residual).max() < 1e-10 * np.abs(found[2]).max()


def test_a_sine_without_delay_begins_with_a_jump():
    """The plate is at rest before 0: the sine's velocity pushes it off."""
    drive = Drive(1e-6, F, "sine")
    motion = modal_motion(OSCILLATORS._replace(participation=np.ones((3, 1))), [drive], 1e-3)
    value, velocity, _ = motion.evaluate(np.zeros(1))[:, 0]
    assert np.abs(value).max() < 1e-20
    assert velocity == pytest.approx(-drive.evaluate(0.0)[1] * np.ones(3), rel=1e-12)


@pytest.mark.parametrize("allowed", [1e-3, 1e-5, 1e-7])
@pytest.mark.parametrize("drives", [STROKES, JUMPY], ids=["strokes", "jumps"])
def test_pieces_are_off_by_what_is_allowed_and_not_by_much_less(drives, allowed):
    motion = modal_motion(OSCILLATORS, drives, 3e-3)
    times = np.random.default_rng(0).uniform(0, 3e-3, 3000)
    truth = motion.evaluate(times)
    allowed *= np.abs(truth[2]).max()
    pieces = motion.modal_drives(allowed)
    worst = [np.abs(drive.evaluate(times)[2] - truth[2, :, j]).max() for j, drive in enumerate(pieces)]
    assert max(worst) < 1.05 * allowed
    assert drives is JUMPY or max(worst) > 0.2 * allowed  # a sine's own pieces are shorter
    heights = np.stack([drive.evaluate(times)[0] for drive in pieces], axis=1)
    assert np.abs(heights - truth[0]).max() < 1.05 * allowed / OSCILLATORS.omega.min() ** 2


@pytest.mark.parametrize(
    ("drives", "beside", "since"),
    [
        (STROKES, Drive(1e-6, 40 * F), 0.0),
        ((Drive(1e-6, F), Drive(0.0, F)), Drive(1e-6, 40 * F, delay=60.3 / F), 61 / F),
    ],
    ids=["from the start", "where both repeat"],
)
def test_pieces_begin_where_those_of_another_drive_do(drives, beside, since):
    damped = OSCILLATORS._replace(damping=np.full(3, 0.1))
    motion = modal_motion(damped, drives, 3e-3 if since == 0.0 else 0.1)
    assert (motion.loop >= 0) == (since > 0.0)
    times = since + np.random.default_rng(0).uniform(0, 1 / F, 2000)
    truth = motion.evaluate(times)
    allowed = 1e-5 * np.abs(truth[2]).max()
    own, found = motion.modal_drives(allowed), motion.modal_drives(allowed, beside)
    assert (
        max(np.abs(drive.evaluate(times)[2] - truth[2, :, j]).max() for j, drive in enumerate(found)) < 1.05 * allowed
    )
    counts = [len(breakpoints(drive_table([pieces[0], beside]), since, since + 1 / F)) for pieces in (own, found)]
    marks = len(breakpoints(drive_table([beside]), since, since + 1 / F))
    print(f"{marks} breakpoints, with pieces {counts[0]}, with pieces that begin there {counts[1]}")
    assert counts[1] < 0.8 * counts[0]


def test_pieces_grow_longer_as_the_ringing_decays():
    damped = OSCILLATORS._replace(damping=np.full(3, 0.1))
    motion = modal_motion(damped, [Drive(1e-6, F, cycles=1), Drive(0.0, F)], 0.1)
    begins, intervals = lay_edges(motion.oscillators, motion.course, 1e-5 * motion.largest_acceleration(), np.zeros(0))
    last = begins[intervals == intervals[-1]]
    lengths = np.diff(last)
    assert lengths[-8:].min() > 2 * lengths[:8].max()
    assert len(last) < 300
    assert lengths.max() > 50 * lengths.min()


def test_motion_that_has_settled_is_one_pass_that_repeats():
    damped = OSCILLATORS._replace(damping=np.full(3, 0.1))
    drives = Drive(1e-6, F), Drive(-2e-6, 0.5 * F, delay=0.2e-3)
    settled, long = (modal_motion(damped, drives, end) for end in (1.0, 60e-3))
    assert settled.loop >= 0 and settled.course.edges[-1] < 0.1
    times = np.random.default_rng(5).uniform(0, 60e-3, 200)
    later = 480e-3 + times
    scale = np.abs(long.evaluate(times)).max(axis=(1, 2))
    assert (np.abs(settled.evaluate(times) - long.evaluate(times)).max(axis=(1, 2)) < 1e-9 * scale).all()
    assert (
        np.abs(settled.evaluate(later)[:, times > 40e-3] - long.evaluate(times)[:, times > 40e-3]).max(axis=(1, 2))
        < 1e-9 * scale
    ).all()
    modal = settled.modal_drives(1e-5 * scale[2])
    found = np.stack([drive.evaluate(later)[2] for drive in modal], axis=1)
    assert np.abs(found - settled.evaluate(later)[2]).max() < 1.05e-5 * scale[2]


def test_undamped_ringing_never_settles():
    free = OSCILLATORS._replace(damping=np.zeros(3))
    motion = modal_motion(free, [Drive(1e-6, F), Drive(1e-6, F)], 20e-3)
    assert motion.loop == -1 and motion.course.edges[-1] >= 20e-3


def test_ringing_without_end_is_refused_with_what_to_change(monkeypatch):
    monkeypatch.setattr(motion_module, "MAX_PIECES", 100)
    motion = modal_motion(OSCILLATORS, STROKES, 3e-3)
    with pytest.raises(ValueError, match=r"takes \d+ pieces in time.*raise plate.damping, reduce run.duration"):
        motion.modal_drives(1e-6 * motion.largest_acceleration())
