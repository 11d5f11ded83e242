"""The corrections over time: closed form, oracle, measured errors, jumps, periods and what is refused."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from reduced_plates import one_correction, one_in_plane, one_plate, random_plate
from reduced_solver import reduced_equilibrium

from coupling.stretch import correction_drives, equilibrium_at
from fem_plate.large_deflection import ReducedPlate
from particle import Drive, Segment, SegmentDrive
from particle.drives import drive_table

SHORT = Drive(1.2, 300.0)


def rows(drives, times):
    """Values, rates and accelerations (3, drives, times)."""
    return np.stack([drive.evaluate(times) for drive in drives], axis=1)


def oracle(plate, drives, time):
    return reduced_equilibrium(plate, *rows(drives, np.array([time]))[:, :, 0])


@pytest.fixture(scope="module")
def two():
    """A plate under two drives of different frequencies."""
    drives = [Drive(1.0, 300.0), Drive(-0.6, 400.0)]
    plate = random_plate(2, 6, 5, 4)
    return plate, drives, correction_drives(plate, drives, 20e-3)


def test_one_correction_is_its_closed_form_at_all_times():
    found = correction_drives(one_plate(), [SHORT], 20e-3, 1e-9)
    times = np.linspace(0, 20e-3, 2003)
    d = SHORT.evaluate(times)[0]
    truth = one_correction(d), one_in_plane(d)
    assert np.abs(found.drives[0].evaluate(times)[0] - truth[0]).max() < 1.2e-9 * np.abs(truth[0]).max()
    assert np.abs(found.in_plane[0].evaluate(times)[0] - truth[1]).max() < 1.2e-9 * np.abs(truth[1]).max()


@pytest.mark.parametrize("tolerance", [1e-3, 1e-5, 1e-7])
def test_the_error_measured_is_the_largest_there_is(tolerance):
    found = correction_drives(one_plate(), [SHORT], 20e-3, tolerance)
    times = np.linspace(0, 1 / 300, 4001)
    for drive, truth, error in (
        (found.drives[0], one_correction(SHORT.evaluate(times)[0]), found.error),
        (found.in_plane[0], one_in_plane(SHORT.evaluate(times)[0]), found.in_plane_error),
    ):
        off = np.abs(drive.evaluate(times)[0] - truth).max() / np.abs(truth).max()
        assert error <= tolerance
        assert drive.error == error
        assert 0.3 * error < off < 1.1 * error


def test_the_pieces_converge_with_the_sixth_order():
    counts = [correction_drives(one_plate(), [SHORT], 20e-3, 10.0**-k).pieces for k in (4, 7, 10)]
    assert counts[1] / counts[0] == pytest.approx(10**0.5, rel=0.35)
    assert counts[2] / counts[0] == pytest.approx(10, rel=0.35)


def test_nodes_are_those_of_the_oracle(two):
    plate, drives, found = two
    pieces = found.drives[0].segments()
    for time in pieces.since[1::9] + 1e-12:  # rounding puts a piece before its begin
        truth = oracle(plate, drives, time)
        scale = np.abs(truth.corrections).max(axis=1, keepdims=True)
        values = rows(found.drives, np.array([time]))[:, :, 0]
        assert (np.abs(values - truth.corrections) < [[1e-11], [1e-8], [1e-6]] * scale).all()
        scale = np.abs(truth.in_plane).max(axis=1, keepdims=True)
        values = rows(found.in_plane, np.array([time]))[:, :, 0]
        assert (np.abs(values - truth.in_plane) < [[1e-11], [1e-8], [1e-6]] * scale).all()


def test_all_times_are_as_good_as_measured(two):
    plate, drives, found = two
    times = np.random.default_rng(0).uniform(0, 10e-3, 150)
    truths = [oracle(plate, drives, time) for time in times]
    c, c_tt = (np.array([truth.corrections[order] for truth in truths]).T for order in (0, 2))
    g = np.array([truth.in_plane[0] for truth in truths]).T
    values = rows(found.drives, times)
    assert found.error < 1e-6
    assert np.abs(values[0] - c).max() < 1.1 * found.error * np.abs(c).max()
    assert np.abs(values[2] - c_tt).max() < 1.1 * found.acceleration_error * np.abs(c_tt).max()
    assert np.abs(rows(found.in_plane, times)[0] - g).max() < 1.1 * found.in_plane_error * np.abs(g).max()


def test_weights_decide_which_corrections_need_digits(two):
    plate, drives, found = two
    light = correction_drives(plate, drives, 20e-3, weights=[1.0, *[1e-6] * 5], in_plane_weights=[1.0, *[1e-6] * 3])
    low = correction_drives(plate, drives, 20e-3, floor=100.0, in_plane_floor=1000.0)
    assert low.pieces < light.pieces < found.pieces
    times = np.linspace(0, 10e-3, 301)
    first = rows(found.drives, times)[0, 0]
    off = np.abs(rows(light.drives, times)[0, 0] - first).max()
    assert off < (light.error + found.error) * np.abs(rows(found.drives, times)[0]).max()


def test_what_repeats_is_computed_once(two):
    plate, drives, found = two
    assert found.period == pytest.approx(10e-3, rel=1e-15)
    later = found.drives[0].segments()
    assert later.repeats == np.inf and later.span == pytest.approx(10e-3, rel=1e-14)
    for time in (0.0123, 0.0777, 7.0001):
        truth = oracle(plate, drives, time).corrections[0]
        assert np.abs(rows(found.drives, np.array([time]))[0, :, 0] - truth).max() < 2e-6 * np.abs(truth).max()


def test_a_period_begins_when_the_last_drive_has_begun_and_others_have_ended():
    drives = [Drive(1.0, 300.0, delay=1e-3), Drive(-0.6, 400.0, phase=1.0), Drive(0.5, 1000.0, cycles=3, delay=2e-3)]
    plate = random_plate(3, 4, 4)
    found = correction_drives(plate, drives, 0.1)
    pieces = found.drives[0].segments()
    assert pieces.lead_time == pytest.approx(5e-3, rel=1e-12)
    assert pieces.span == found.period == pytest.approx(10e-3, rel=1e-12)
    for time in (0.4e-3, 1.7e-3, 4.1e-3, 6e-3, 14.9e-3, 15.1e-3, 0.0876):
        truth = oracle(plate, drives, time).corrections[0]
        assert np.abs(rows(found.drives, np.array([time]))[0, :, 0] - truth).max() < 2e-6 * np.abs(truth).max()


@pytest.mark.parametrize("frequency", [300.0 * 2**0.5, 300.0 * 1009 / 1013])
def test_drives_without_a_common_period_are_followed_to_the_end(frequency):
    drives, plate = [Drive(1.0, 300.0), Drive(-0.6, frequency)], random_plate(2, 3, 3)
    found = correction_drives(plate, drives, 30e-3)
    assert found.period is None
    truth = oracle(plate, drives, 29.9e-3).corrections[0]
    assert np.abs(rows(found.drives, np.array([29.9e-3]))[0, :, 0] - truth).max() < 2e-6 * np.abs(truth).max()


def test_rests_cost_one_piece_and_so_does_what_never_moves():
    wait = Segment(cycle="hold", dwell=1.0)
    drive = SegmentDrive([Segment(1.0, 300.0, "up"), wait, Segment(-1.0, 300.0, "up")])
    found = correction_drives(one_plate(), [drive], 2.0)
    pieces = found.drives[0].segments()
    held = (pieces.since > 1 / 301) & (pieces.since < 1.0)
    assert held.sum() == 1  # it begins at 1/300 s and lasts to the end of the wait
    assert pieces.scale.max() == pytest.approx(1.0, rel=1e-12)
    assert found.drives[0].evaluate([0.5, 1.5])[0] == pytest.approx([one_correction(1.0), 0.0], rel=1e-12, abs=1e-12)
    still = correction_drives(random_plate(2, 3, 3), [Drive(0.0, 300.0)] * 2, 1.0)
    assert still.pieces == 1 and still.error < 1e-14


def jumps(found):
    return (drive_table([*found.drives, *found.in_plane]).jump > 0).tolist()


@pytest.mark.parametrize(
    ("drive", "expected"),
    [
        (SHORT, [False, False]),
        (Drive(1.0, 300.0, cycles=4), [False, False]),
        (Drive(1.0, 300.0, "cosine", delay=1e-3, cycles=2), [False, True]),
        (Drive(1.0, 300.0, phase=0.7, delay=1e-3), [True, True]),
        (Drive(1.0, 311.0 * 2**0.5), [False, False]),
    ],
    ids=["up-down", "counted", "cosine", "phase", "cut off"],
)
def test_derivatives_jump_where_those_of_the_drives_do(drive, expected):
    beside = Drive(0.5, 300.0, delay=0.2e-3)
    found = correction_drives(random_plate(2, 3, 3, 2), [drive, beside], 9.7e-3, 1e-5)
    assert jumps(found) == [expected] * 5


def test_both_sides_of_a_jump_are_the_oracles():
    drives = [Drive(1.0, 300.0, phase=0.7, delay=1e-3), Drive(0.5, 400.0)]
    plate = random_plate(2, 3, 3)
    found = correction_drives(plate, drives, 20e-3)
    for time in (1e-3 - 1e-10, 1e-3 + 1e-10):
        truth = oracle(plate, drives, time).corrections
        values = rows(found.drives, np.array([time]))[:, :, 0]
        assert np.abs(values[1] - truth[1]).max() < 1e-6 * np.abs(truth[1]).max()
        assert np.abs(values[2] - truth[2]).max() < 1e-4 * np.abs(truth[2]).max()
    assert abs(drives[0].evaluate(1e-3 + 1e-10)[1]) > 100  # m/s: there is a jump to miss


def test_equal_drives_are_one():
    plate, drives = random_plate(6, 4, 4, 2), [Drive(0.5, 300.0), Drive(0.4, 400.0), Drive(0.5, 300.0)] * 2
    found = correction_drives(plate, drives, 20e-3)
    for time in (1.1e-3, 8.7e-3):
        truth = oracle(plate, drives, time)
        values = rows([*found.drives, *found.in_plane], np.array([time]))[0, :, 0]
        assert values == pytest.approx(np.concatenate([truth.corrections[0], truth.in_plane[0]]), abs=3e-6)


def test_the_same_bits_on_any_thread(two):
    plate, drives, found = two
    with ThreadPoolExecutor(4) as pool:
        others = list(pool.map(lambda _: correction_drives(plate, drives, 20e-3), range(8)))
    for other in others:
        for one, same in zip(found.drives, other.drives, strict=True):
            assert np.array_equal(one.segments().coefficients, same.segments().coefficients)


@pytest.mark.parametrize("size", [0.3, 1.0, 5.0])
def test_the_equilibrium_under_drives_that_stand_still_is_the_oracles(size):
    plate, d = random_plate(3, 6, 5, 4, size=size), np.array([1.0, -2.0, 1.5])
    corrections, motions = equilibrium_at(plate, d)
    truth = reduced_equilibrium(plate, d)
    assert corrections == pytest.approx(truth.corrections[0], rel=1e-11)
    assert motions == pytest.approx(truth.in_plane[0], rel=1e-11)


def test_an_equilibrium_that_is_not_stable_is_refused():
    plate = ReducedPlate([[1.0]], [[[0.0, 0.0], [0.0, 1.0]]], prestress=[-1.5])
    with pytest.raises(ValueError, match="not stable there: its energy is not least"):
        equilibrium_at(plate, np.zeros(1))


def test_a_plate_that_buckles_is_refused_with_the_time():
    # The drive presses the correction, f = -d, which has no stable shape at 0 once d > 1; nothing pushes it aside.
    plate = ReducedPlate([[1.0]], [[[-2.0, 0.0], [0.0, 1.0]]])
    assert correction_drives(plate, [Drive(0.9, 300.0)], 3e-3).error == 0
    with pytest.raises(ValueError, match=r"not stable at 0\.00\d+ s"):
        correction_drives(plate, [Drive(1.2, 300.0)], 3e-3)


@pytest.mark.parametrize(
    ("wrong", "names"),
    [
        ({"drives": [SHORT] * 2, "end": 0.0}, "drives end"),
        ({"tolerance": 1e-14, "weights": [-1.0], "floor": -1.0}, "weights tolerance floor"),
        ({"in_plane_weights": [1.0, 1.0], "in_plane_floor": np.nan}, "in_plane_weights in_plane_floor"),
    ],
)
def test_every_wrong_input_is_named(wrong, names):
    with pytest.raises(ValueError) as caught:
        correction_drives(**{"plate": one_plate(), "drives": [SHORT], "end": 1.0} | wrong)
    parts = str(caught.value).split("; Input ")
    assert [part.removeprefix("Input ").split()[0] for part in parts] == names.split()
