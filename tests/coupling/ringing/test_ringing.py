"""A plate that stretches and has mass: its energy, its frequency, its limits."""

from functools import cache

import numpy as np
import pytest
from scipy.optimize import brentq

from coupling.ringing import make_ringing_model, motion
from coupling.ringing.forces import accelerate, driven_by_powers, fill_node, new_bench, ringing_of
from coupling.ringing.motion import ringing_corrections
from coupling.stretch import make_model
from coupling.vibration import always_running, choice, make_vibration_model, motion_of
from fem_plate import Plate, PlateSection, backbone
from fem_plate.large_deflection import ReducedPlate
from meshes import disc
from particle import Drive, kernel
from tests.reference.radial_stretching import StretchingDisc
from tests.reference.reduced_solver import energy

THICKNESS, RADIUS = 5e-6, 300e-6
SECTION = PlateSection(169e9, 0.3, THICKNESS, 2330.0)
PLATE = Plate(disc(RADIUS, 75e-6), SECTION, "clamped", tolerance=1e-4)
CENTRE = np.zeros((1, 2))
STILL = Drive(0.0, 1e3, "up")
TIMES = np.linspace(0.0, 2e-5, 50)


def damping(ratio):
    return lambda frequencies: np.full(len(frequencies), ratio)


@cache
def model(stroke=2 * THICKNESS, ratio=0.0, frequency=20e3, steady=False):
    """A disc with one actuator at its centre, good for a stroke [m]."""
    drives = [Drive(stroke, frequency)]
    plain = make_model(PLATE.large_deflection(CENTRE), [drives], 1e-3, lambda done, of: None)
    return make_ringing_model(plain, damping(ratio), [drives], 2 / frequency, steady)


def free(plate, amplitude, periods, allowed=1e-3):
    """Free vibration from rest in the first mode at an amplitude [m]; allowed: of the acceleration, in pieces."""
    omega = plate.chosen.modes.omega
    q = np.zeros(plate.count)
    q[0] = amplitude
    limits = plate.limits(allowed * omega[0] ** 2 * amplitude)
    end = periods * 2 * np.pi / omega[0]
    return ringing_corrections(plate.ringing, [STILL], end, (q, np.zeros_like(q)), limits)[0]


@pytest.mark.slow
@pytest.mark.compiled
def test_free_vibration_at_two_thicknesses_keeps_its_energy():
    plate = model()
    found = free(plate, 2 * THICKNESS, 5)
    times = found.drives[0].segments().start[1:-1]
    values = np.array([drive.evaluate(times) for drive in found.drives])  # (n, 3, k), exact where pieces meet
    kinetic = 0.5 * np.einsum("a,ak->k", plate.ringing.mass, values[: plate.count, 1] ** 2)
    total = kinetic + [energy(plate.plate, row, np.zeros(1)) for row in values[:, 0].T]
    print(f"energy drifts by {np.ptp(total) / total[0]:.1e} over {len(times)} pieces")
    assert np.ptp(total) < 1e-8 * total[0]
    assert kinetic.max() > 0.5 * total[0]  # it swings


@pytest.mark.slow
@pytest.mark.compiled
def test_powers_of_time_stand_for_many_drives(monkeypatch):
    drive = Drive(THICKNESS, 100e3, delay=3e-6)
    plate = model(THICKNESS, 0.02, 100e3)
    one = plate.corrections([drive], 4e-5)
    monkeypatch.setattr(motion, "FEW_DRIVES", 0)
    other = plate.corrections([drive], 4e-5)
    assert one.pieces == other.pieces
    assert not np.array_equal(one.drives[0].evaluate(TIMES), other.drives[0].evaluate(TIMES))  # sums in another order
    for own, same in zip(one.drives, other.drives, strict=True):
        for values, expected in zip(same.evaluate(TIMES), own.evaluate(TIMES), strict=True):
            np.testing.assert_allclose(values, expected, rtol=0, atol=1e-8 * np.abs(expected).max())


@pytest.mark.compiled
def test_powers_of_time_accelerate_modes_as_the_drives_that_are_sums_of_them():
    rng, count, modes, n = np.random.default_rng(0), 9, 2, 3
    forms = rng.normal(size=(6, count + modes + n, count + modes + n))
    forms = forms + forms.transpose(0, 2, 1)
    plate = ReducedPlate(50.0 * np.eye(n), forms[:4], in_plane=forms[4:])
    own = np.array([1.0, 4.0]), np.array([0.1, 0.2]), np.array([1.0, 2.0])
    many = ringing_of(plate.forms, *own, rng.normal(size=(modes, count)))
    pieces, q, q_t = 0.1 * rng.normal(size=(count, 6)), 0.1 * rng.normal(size=modes), rng.normal(size=modes)
    found = []
    for ringing, rows in ((many, pieces), (driven_by_powers(many, pieces), np.eye(6))):
        bench, out, node = new_bench(ringing), np.zeros(modes), np.zeros((3, modes + n + 2))
        bench.pieces[:] = rows
        _accelerated(ringing, bench, q, q_t, out, node)
        found.append(node)
    np.testing.assert_allclose(found[1], found[0], rtol=0, atol=1e-10 * np.abs(found[0]).max())


@kernel
def _accelerated(ringing, bench, q, q_t, out, node):
    accelerate(ringing, bench, 0.3, 0.7, q, q_t, out, False, True)
    fill_node(ringing, bench, q, q_t, out, node)


def zero(drive, low, high):
    return brentq(lambda t: float(drive.evaluate(t)[0]), low, high, xtol=1e-18, rtol=1e-14)


@pytest.mark.slow
@pytest.mark.compiled
def test_frequency_rises_with_the_amplitude_along_the_backbone():
    """omega^2 / omega_1^2 - 1 -> kappa (A/t)^2, with kappa from the mode's energy of stretching alone."""
    plate = model()
    omega, rise = plate.chosen.modes.omega[0], []
    for amplitude in (0.1, 0.05):
        first = free(plate, amplitude * THICKNESS, 3.3, 1e-6).drives[0]
        zeros = [zero(first, *(np.array([k, k + 1]) * np.pi / omega)) for k in (0, 5)]
        period = (zeros[1] - zeros[0]) / 2.5
        rise.append(((2 * np.pi / period / omega) ** 2 - 1) / amplitude**2)
    limit = rise[1] + (rise[1] - rise[0]) / 3
    expected = backbone(PLATE, 3, CENTRE)[2]  # two lower ones leave the centre at rest by themselves
    print(f"kappa {limit:.6f}, from the energy {expected:.6f}")
    assert limit == pytest.approx(expected, rel=1e-4)


@pytest.mark.slow
@pytest.mark.compiled
def test_small_strokes_are_those_of_a_plate_that_does_not_stretch(monkeypatch):
    for left_out in ("TOLERANCE", "DROPPED"):  # modes that only one of the two leaves out are no difference in theory
        monkeypatch.setattr(choice, left_out, 0.1 * getattr(choice, left_out))
    stroke, frequency = 1e-4 * THICKNESS, 20e3
    plate, drives = model(stroke, 0.02, frequency), [Drive(stroke, frequency)]
    found = plate.corrections(drives, 2 / frequency)
    linear = make_vibration_model(PLATE.influence(CENTRE), SECTION, damping(0.02), [drives], 2 / frequency, False)
    times = np.linspace(0.1, 1.9, 200) / frequency
    xy = RADIUS * np.array([[0.3, 0.1], [-0.2, 0.5], [0.05, -0.8]])
    moving = [*drives, *found.drives]
    accelerations = [
        shapes.values(xy) @ np.array([drive.evaluate(times)[2] for drive in all_drives])
        for shapes, all_drives in ((plate.shapes, moving), (linear.shapes, [*drives, *linear.modal_drives(drives)]))
    ]
    largest = np.abs(accelerations[1]).max()
    print(f"accelerations differ by {np.abs(accelerations[0] - accelerations[1]).max() / largest:.1e}")
    assert accelerations[0] == pytest.approx(accelerations[1], abs=2e-4 * largest)


@pytest.mark.slow
@pytest.mark.compiled
@pytest.mark.parametrize(("frequency", "height", "allowed"), [(20e3, 1.0, (1e-5, 2e-3)), (259e3, 0.5, (1e-5, 3e-3))])
def test_driven_motion_is_that_of_a_disc_by_bessel_functions(frequency, height, allowed):
    """At .04 and .5 of the first frequency. Without inertia w_tt is 8 % and 94 % off."""
    drive = Drive(height * THICKNESS, frequency)
    rigidity = SECTION.rigidity / (SECTION.density * THICKNESS * RADIUS**4)
    times, r = np.linspace(0.05, 0.98, 9) / frequency, np.array([0.15, 0.3, 0.6])
    oracle = StretchingDisc(12, np.sqrt(rigidity), 0.02)
    exact = THICKNESS * oracle.motion(lambda t: np.array(drive.evaluate(t)) / THICKNESS, times, r)
    plate = model(height * THICKNESS, 0.02, frequency)
    found = plate.corrections([drive], 1 / frequency)
    moving = [drive, *found.drives]
    values = plate.shapes.values(RADIUS * np.column_stack([r, 0 * r]))
    for order, limit in zip((0, 2), allowed, strict=True):
        w = values @ np.array([one.evaluate(times)[order] for one in moving])
        largest = np.abs(exact[order]).max()
        print(f"order {order}: {np.abs(w.T - exact[order]).max() / largest:.1e}")
        np.testing.assert_allclose(w.T, exact[order], rtol=0, atol=limit * largest)


@pytest.mark.slow
@pytest.mark.compiled
def test_a_steady_state_is_what_a_run_from_rest_comes_to():
    drive = Drive(0.5 * THICKNESS, 100e3)
    steady = model(drive.stroke, 0.1, drive.frequency, steady=True).corrections([drive], 2 / drive.frequency)
    from_rest = model(drive.stroke, 0.1, drive.frequency).corrections([drive], 60 / drive.frequency)
    assert steady.period == pytest.approx(1 / drive.frequency)
    assert from_rest.period == pytest.approx(1 / drive.frequency)
    assert from_rest.pieces > 2 * steady.pieces  # it rings before it repeats
    times = np.linspace(0, 1.5, 40) / drive.frequency
    for one, other in zip(steady.drives, from_rest.drives, strict=True):
        later = other.evaluate(times + 50 / drive.frequency)
        for now, then in zip(one.evaluate(times), later, strict=True):
            np.testing.assert_allclose(now, then, rtol=0, atol=2e-4 * np.abs(then).max() + 1e-30)


@pytest.mark.slow
@pytest.mark.compiled
def test_without_a_common_period_there_is_no_steady_state():
    plate = model(0.5 * THICKNESS, 0.1, 100e3, steady=True)
    once = Drive(0.5 * THICKNESS, 100e3, "up")
    with pytest.raises(
        ValueError, match=r'start must be "rest" for a stretching plate whose drives have no common period'
    ):
        plate.corrections([once], 1e-4)


@pytest.mark.slow
@pytest.mark.compiled
@pytest.mark.parametrize("delay", [3e-6])
def test_a_small_steady_state_is_that_of_a_plate_that_does_not_stretch(delay):
    """A delay is a shift within the period."""
    drive = always_running(Drive(1e-4 * THICKNESS, 100e3, delay=delay))
    plate = model(1e-4 * THICKNESS, 0.05, 100e3, steady=True)
    expected = motion_of(plate.chosen.modes, plate.damping, [drive], 1e-4, True).evaluate(TIMES)
    found = plate.corrections([drive], 1e-4).drives[: plate.count]
    for order in range(3):
        values = np.array([one.evaluate(TIMES)[order] for one in found]).T
        largest = np.abs(expected[order]).max()
        np.testing.assert_allclose(values, expected[order][:, : plate.count], rtol=0, atol=1e-4 * largest)
