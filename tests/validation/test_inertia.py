"""Plates that vibrate, against exact radial series, which share nothing with the code but the drives.

The series are those of `radial_vibration`; printed figures are of another implementation of the same.
"""

import numpy as np
import pytest
from radial_vibration import FORCE, HELD, Piece, RadialDisc, Wave, strokes

from active_surface.studies.response import response
from coupling import build_surface, read_case
from coupling.case import ActuatorCase, Case, ConstantCase, PartCase, RunCase
from coupling.run import build_scene
from fem_plate import Excitation, Plate, PlateSection
from meshes import disc

pytestmark = pytest.mark.compiled

E, NU, DENSITY, THICKNESS, RADIUS = 169e9, 0.3, 2330.0, 5e-6, 300e-6
RIGIDITY = E * THICKNESS**3 / 12 / (1 - NU**2)
UNIT = np.sqrt(RIGIDITY / (DENSITY * THICKNESS)) / RADIUS**2  # rad/s
PLATE = {
    "shape": "disc",
    "radius": RADIUS,
    "youngs_modulus": E,
    "poisson_ratio": NU,
    "thickness": THICKNESS,
    "density": DENSITY,
    "inertia": True,
}
R = np.array([0.3, 0.6])
CENTRE = (0.0, 0.0)
DISC = RadialDisc()
FIRST = DISC.k[0] ** 2 * UNIT / (2 * np.pi)  # Hz
UNIT_SECTION = PlateSection(12 * (1 - NU**2), NU, 1.0, 1.0)


def case_of(actuators, duration, plate=(), **run):
    return Case(
        plate=PLATE | dict(plate),
        actuators=actuators if isinstance(actuators, list) else [actuators],
        part=PartCase(mass=2e-9, position=(90e-6, 0.0)),
        friction=ConstantCase(limit=1e-8),
        run=RunCase(duration=duration, **run),
        name="ringing",
    )


def on_radii(radii=R):
    """Points there, in different directions."""
    angle = 0.7 * np.arange(len(radii))
    return RADIUS * radii[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def off(surface, pieces, times, disc=DISC, ratio=0.02, radii=R):
    """The largest errors of w and w_tt over the largest of these."""
    found = [surface.evaluate(on_radii(radii), time) for time in times]
    truth = np.array([disc.motion(pieces, radii, time, UNIT, ratio)[[0, 2]] for time in times])
    values = np.array([[state.w, state.w_tt] for state in found])
    return np.abs(values - truth).max(axis=(0, 2)) / np.abs(truth).max(axis=(0, 2))


def up_down(frequency, stroke=1e-6, **further):
    return ActuatorCase(position=CENTRE, stroke=stroke, frequency=frequency, **further)


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


@pytest.mark.parametrize("share, cycles", [pytest.param(0.2, 8, marks=pytest.mark.slow), (0.95, 20)])
def test_strokes_near_the_first_frequency(share, cycles):
    end = cycles / (share * FIRST)
    surface = build_surface(case_of(up_down(share * FIRST), end))
    times = np.random.default_rng(1).uniform(0, end, 25)
    in_w, in_w_tt = off(surface, strokes(1e-6, share * FIRST, cycles + 1), times, radii=np.array([0.15, 0.3, 0.6, 0.8]))
    assert in_w < 1e-5 and in_w_tt < 1e-3


def test_frequencies_of_held_discs():
    """Those of the centre to all printed digits, and of two actuators; also as the modes that actuators excite."""
    plate = Plate(disc(1.0, 0.1), UNIT_SECTION)
    shapes = plate.influence([CENTRE])
    excitation = Excitation(shapes, 1.0, 1.0)
    for _ in range(15):
        excitation.grow()
    assert DISC.k[:3] ** 2 == pytest.approx([22.736774494, 61.951920493, 121.177263857], rel=5e-11)
    modes = excitation.modes()
    radial = np.abs(modes.participation[:, 0]) > 1e-3
    assert modes.omega[radial][:3] == pytest.approx(DISC.k[:3] ** 2, rel=1e-6)
    psi = DISC.psi(np.array([0.37]))[0, :3] * DISC.participation[:3]
    found = modes.functions.values(np.array([[0.37 * np.cos(1), 0.37 * np.sin(1)]]))[0] * modes.participation[:, 0]
    assert found[radial][:3] == pytest.approx(psi, rel=1e-4)
    two = [(0.3, 0.1), (-0.25, -0.35)]
    assert 2 * np.pi * plate.frequencies(2, two) == pytest.approx([19.077528, 26.1383], rel=2e-6)
    assert 2 * np.pi * plate.frequencies(1, two)[0] == pytest.approx(19.077528, rel=1e-6)


@pytest.mark.parametrize(
    "stiffness", [HELD, *(pytest.param(stiffness, marks=pytest.mark.slow) for stiffness in (FORCE, 40.0, 4000.0))]
)
def test_responses_of_a_clamped_disc(stiffness):
    """Held, on springs or under a force at its centre: resonances, amplitude and phase, on and beside resonances."""
    exact = RadialDisc("clamped", NU, stiffness, 100)
    actuator, scale = {"stroke": 1e-6, "frequency": 20e3}, 1.0
    if stiffness == FORCE:
        actuator, scale = {"force": 1e-3, "frequency": 20e3}, RADIUS**2 / RIGIDITY
    elif stiffness != HELD:
        actuator["stiffness"] = stiffness * RIGIDITY / RADIUS**2
    resonances = exact.k[:3] ** 2 * UNIT / (2 * np.pi)
    frequencies = np.sort([*(np.array([0.1, 0.5, 0.95, 2.0]) * resonances[0]), *resonances, *(1.01 * resonances)])
    case = case_of(ActuatorCase(position=CENTRE, **actuator), 1e-3)
    found = response(case, on_radii(), frequencies)
    truth = scale * exact.transfer(R, 2 * np.pi * frequencies / UNIT, 0.02)
    assert np.abs(found.values[:, 0] - truth).max(axis=1) == pytest.approx([0, 0], abs=1e-4 * np.abs(truth).max())
    assert (np.abs(found.values[:, 0] - truth) < 3e-3 * np.abs(truth)).all()
    default = response(case, on_radii())
    assert default.resonances[:2] == pytest.approx(resonances[:2], rel=1e-6)
    if stiffness == FORCE:  # no hold: J0 and I0 alone
        assert exact.k[:1] == pytest.approx([3.196220617], rel=1e-9)  # J0 I1 + J1 I0 = 0


FREE = """\
[plate]
shape = "disc"
radius = "300 um"
youngs_modulus = "169 GPa"
poisson_ratio = 0.3
thickness = "5 um"
density = "2330 kg/m^3"
supports = "free"
[[actuators]]
position = ["0 um", "0 um"]
stroke = "1 um"
frequency = "20 kHz"
[part]
mass = "2e-9 kg"
position = ["100 um", "0 um"]
[friction]
model = "constant"
limit = "10 nN"
[run]
duration = "1 ms"
"""


def test_responses_of_a_free_disc_that_rides_on_its_actuator(tmp_path):
    """Its two tilts are left; a run of it is refused, its response is not."""
    (tmp_path / "free.toml").write_text(FREE)
    with pytest.raises(ValueError, match=r"plate\.supports +leave the plate free to move as a whole"):
        read_case(tmp_path / "free.toml")
    case, exact, radii = (
        read_case(tmp_path / "free.toml", may_move=True),
        RadialDisc("free"),
        np.array([0.3, 0.6, 0.95]),
    )
    assert exact.k[:3] ** 2 == pytest.approx([3.75196802, 20.90810067, 60.64453608], rel=1e-9)
    own = exact.k[:3] ** 2
    omega = np.sort([0.1, 1.0, 3.0, 4.2, 10.0, 15.0, 25.0, 40.0, *own])
    found = response(case, on_radii(radii), omega * UNIT / (2 * np.pi))
    off = np.abs(found.values[:, 0] - exact.transfer(radii, omega, 0.02)) / np.abs(found.values[:, 0])
    assert (off[:, ~np.isin(omega, own)] < 1e-5).all() and (off < 1e-3).all()
    assert found.resonances == pytest.approx(own[:3] * UNIT / (2 * np.pi), rel=1e-5)


def test_shapes_of_a_free_plate_have_no_share_of_the_tilts_left():
    """Under one actuator beside the middle of a disc: phi = 1 - c.(x - a), with c = -a / (a^2 + 1/4)."""
    plate, at = Plate(disc(1.0, 0.2), UNIT_SECTION, "free"), np.array([0.3, 0.1])
    with pytest.raises(ValueError, match="leave the plate a rigid motion"):
        plate.influence([at])
    with pytest.raises(ValueError, match="leave the plate a rigid motion"):
        plate.influence([at, (0.0, 0.0)], [np.inf, 0.0], free_motions=True)
    xy = np.random.default_rng(5).uniform(-0.7, 0.7, (20, 2))
    c = -at / (at @ at + 0.25)
    assert plate.influence([at], free_motions=True).values(xy)[:, 0] == pytest.approx(1 - (xy - at) @ c, abs=1e-9)
    three = [(0.5, 0.0), (-0.2, 0.4), (-0.3, -0.5)]  # they leave nothing
    held = [plate.influence(three, free_motions=free).values(xy) for free in (True, False)]
    assert (held[0] == held[1]).all()


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


TENSION, UNIT_TENSION = 30.0, RIGIDITY / RADIUS**2
TENSE = RadialDisc(tension=TENSION)
TENSE_FIRST = TENSE.omega[0] * UNIT / (2 * np.pi)  # Hz


def test_the_series_under_tension():
    """Its static force is that of the plate, its modes add up to its shape, and it goes over into that without."""
    for tension, ratio in ((10.0, 1.5998789), (100.0, 6.0058331)):
        tense = RadialDisc(stiffness=FORCE, tension=tension)
        assert 1 / tense.phi(np.zeros(1))[0] / (16 * np.pi) == pytest.approx(ratio, rel=1e-7)
    s, weights = np.polynomial.legendre.leggauss(100)
    r, dr = (1 + s) / 2, weights / 2
    whole = 2 * np.pi * (r * dr) @ TENSE.phi(r) ** 2
    assert TENSE.participation**2 @ TENSE.norms == pytest.approx(whole, rel=2e-4)  # falls as 1/count^2
    slack = RadialDisc(tension=1e-5, count=8)
    assert slack.omega == pytest.approx(DISC.omega[:8], rel=1e-6) and slack.phi(R) == pytest.approx(
        DISC.phi(R), rel=1e-6
    )
    membrane = RadialDisc(stiffness=FORCE, tension=1e8, count=5).omega / 1e4  # J0(k) = 0
    assert membrane == pytest.approx([2.40482556, 5.52007811, 8.65372791, 11.79153444, 14.93091771], rel=2e-4)


def test_frequencies_and_responses_under_tension():
    tense = {"tension": TENSION * UNIT_TENSION}
    frequencies = np.array([0.1, 0.5, 0.95, 1.0, 1.02, 2.0]) * TENSE_FIRST
    case = case_of(up_down(20e3), 1e-3, tense)
    found = response(case, on_radii(), frequencies)
    truth = TENSE.transfer(R, 2 * np.pi * frequencies / UNIT, 0.02)
    assert (np.abs(found.values[:, 0] - truth) < 1e-4 * np.abs(truth)).all()
    assert response(case, on_radii()).resonances[:2] == pytest.approx(TENSE.omega[:2] * UNIT / (2 * np.pi), rel=1e-6)


def test_strokes_under_tension_move_the_disc_as_its_series():
    end = 4 / (0.3 * TENSE_FIRST)
    surface = build_surface(
        case_of(up_down(0.3 * TENSE_FIRST), end, {"tension": TENSION * UNIT_TENSION, "cell_size": 60e-6})
    )
    pieces, times = strokes(1e-6, 0.3 * TENSE_FIRST, 5), np.random.default_rng(6).uniform(0, end, 20)
    in_w, in_w_tt = off(surface, pieces, times, TENSE)
    assert in_w < 1e-5 and in_w_tt < 1e-3
    in_w, in_w_tt = off(surface, pieces, times)  # the same disc without tension
    assert in_w > 0.01 and in_w_tt > 0.1


TABLE = (
    (FIRST, 0.05),
    (2 * FIRST, 0.002),
    (6 * FIRST, 0.03),
)  # the second resonance is at 2.72 FIRST, the third at 5.33


def tabled(frequencies):
    """Damping ratios, on straight lines between the table's points and constant beyond."""
    (f_0, z_0), (f_1, z_1), (f_2, z_2) = TABLE
    first, second = (frequencies - f_0) / (f_1 - f_0), (frequencies - f_1) / (f_2 - f_1)
    lines = np.where(frequencies < f_1, z_0 + first * (z_1 - z_0), z_1 + second * (z_2 - z_1))
    return np.where(frequencies < f_0, z_0, np.where(frequencies > f_2, z_2, lines))


DAMPINGS = tabled(DISC.omega * UNIT / (2 * np.pi))


def test_responses_with_a_table_of_damping():
    own = DISC.omega[:3] * UNIT / (2 * np.pi)
    assert DAMPINGS[:3] == pytest.approx([0.05, 0.0070736, 0.0253079], rel=1e-4)
    frequencies = np.sort([*own, *(1.005 * own), *(0.98 * own), 0.3 * FIRST])
    found = response(case_of(up_down(20e3), 1e-3, {"damping": TABLE}), on_radii(), frequencies)
    truth = DISC.transfer(R, 2 * np.pi * frequencies / UNIT, DAMPINGS)
    assert (np.abs(found.values[:, 0] - truth) < 1e-3 * np.abs(truth)).all()
    assert found.dampings == pytest.approx(DAMPINGS[:3], rel=1e-5)


def test_strokes_with_a_table_of_damping_move_the_disc_as_its_series():
    frequency = 0.55 * FIRST
    end = 6 / frequency
    surface = build_surface(case_of(up_down(frequency), end, {"damping": TABLE, "cell_size": 40e-6}))
    pieces, times = strokes(1e-6, frequency, 7), np.random.default_rng(7).uniform(0, end, 20)
    in_w, in_w_tt = off(surface, pieces, times, ratio=DAMPINGS)
    assert in_w < 1e-5 and in_w_tt < 1e-3
    assert off(surface, pieces, times, ratio=0.02)[1] > 0.05  # one ratio for all


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
