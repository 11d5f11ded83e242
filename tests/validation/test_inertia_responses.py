"""Natural frequencies and responses of plates that vibrate, against exact radial series."""

import numpy as np
import pytest
from radial_vibration import FORCE, HELD, RadialDisc
from sweeps import DISC_PLATE
from vibrating_discs import (
    CENTRE,
    DISC,
    NU,
    RADIUS,
    RIGIDITY,
    UNIT,
    UNIT_SECTION,
    R,
    case_of,
    on_radii,
)

from active_surface.studies.response import response
from coupling import read_case
from coupling.case import ActuatorCase
from fem_plate import Excitation, Plate
from meshes import disc

pytestmark = pytest.mark.compiled


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


FREE = (
    DISC_PLATE
    + """\
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
)


@pytest.mark.slow
def test_responses_of_a_free_disc_that_rides_on_its_actuator(tmp_path):
    """Its two tilts are left; a run of it is refused, its response is not."""
    (tmp_path / "free.toml").write_text(FREE)
    with pytest.raises(ValueError, match=r"plate\.supports +must not leave the plate free to move as a whole"):
        read_case(tmp_path / "free.toml")
    case, exact, radii = (
        read_case(tmp_path / "free.toml", may_move=True),
        RadialDisc("free"),
        np.array([0.3, 0.6, 0.95]),
    )
    assert exact.k[:3] ** 2 == pytest.approx([3.75196802, 20.90810067, 60.64453608], rel=1e-9)
    own = exact.k[:3] ** 2
    beyond = own[2] * (1 + 1e-9)  # so that rounding does not decide whether the third resonance lies within the range
    omega = np.sort([0.1, 1.0, 3.0, 4.2, 10.0, 15.0, 25.0, 40.0, beyond, *own])
    found = response(case, on_radii(radii), omega * UNIT / (2 * np.pi))
    off = np.abs(found.values[:, 0] - exact.transfer(radii, omega, 0.02)) / np.abs(found.values[:, 0])
    assert (off[:, ~np.isin(omega, [beyond, *own])] < 1e-5).all() and (off < 1e-3).all()
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
