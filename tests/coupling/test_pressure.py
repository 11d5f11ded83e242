"""A uniform pressure on a plate whose actuators hold it: closed forms, its motion, what counts it, what refuses it."""

import numpy as np
import pytest
from sweeps import DISC

from coupling import Case, InputError, read_case, run_case, shared_surface
from coupling.case import write_case
from coupling.drives import build_drives
from coupling.outlook import largest_forces, limit_warnings
from coupling.run import build_scene, build_surface
from fem_plate import Plate, PlateSection
from fem_plate.analytic import central_load
from meshes import rectangle

A, T, Q = 300e-6, 5e-6, 2000.0  # m, m, Pa
D = 169e9 * T**3 / 12 / (1 - 0.3**2)
BULGE = Q * A**4 / (64 * D)  # m, of the middle without actuators
GIVES = A**2 / (16 * np.pi * D)  # m/N, of the middle
R = np.array([0.0, 0.1, 0.35, 0.6, 0.9]) * A
ON = np.stack([R * 0.6, R * 0.8], axis=1)
CENTRE = {"position": (0.0, 0.0), "stroke": 1e-6, "frequency": 300.0}
ASIDE = {"position": (80e-6, 40e-6), "stroke": 0.5e-6, "frequency": 400.0}
PLATE = DISC | {"density": 2330.0, "cell_size": 40e-6}


def case_with(*actuators, run=None, **plate):
    return Case(
        plate=PLATE | plate,
        actuators=list(actuators),
        part={"mass": 1e-12, "position": (100e-6, 20e-6)},
        friction={"model": "constant", "limit": 1e-6},
        run={"duration": 5e-3} | (run or {}),
    )


def bulge(force):
    """The clamped disc under the pressure and a central force [N], in closed form."""
    return Q * (A**2 - R**2) ** 2 / (64 * D) + central_load(R, A, D, force)


HOLDS = {
    "rigid": ({}, -BULGE / GIVES),
    "spring": ({"stiffness": 300.0}, -BULGE / (GIVES + 1 / 300.0)),
    "force": ({"stroke": None, "force": 1e-6}, 0.0),
}


@pytest.mark.parametrize("held", HOLDS)
def test_an_idle_actuator_holds_the_disc_as_in_closed_form(held):
    more, force = HOLDS[held]
    case = case_with({**CENTRE, **more, "delay": 1e-3}, pressure=Q)
    state = build_surface(case).evaluate(ON, 0.5e-3)
    assert np.abs(state.w - bulge(force)).max() < 1e-6 * BULGE
    assert not state.w_t.any() and not state.w_tt.any()


def test_strokes_add_their_shapes():
    times = (0.0, 0.4e-3, 2.1e-3)
    plain, pressed = (build_surface(case_with(CENTRE, ASIDE, pressure=q)) for q in (0.0, Q))
    idle = build_surface(case_with(CENTRE | {"delay": 1.0}, ASIDE | {"delay": 1.0}, pressure=Q)).evaluate(ON, 0.0).w
    for time in times:
        state, alone = pressed.evaluate(ON, time), plain.evaluate(ON, time)
        assert np.abs(state.w - alone.w - idle).max() < 1e-14
        assert np.abs(state.w_tt - alone.w_tt).max() < 1e-7 * max(np.abs(alone.w_tt).max(), 1e-9)


@pytest.mark.slow
def test_a_plate_on_actuators_alone_bears_all_of_the_pressure_there():
    plate = Plate(rectangle(400e-6, 300e-6, 40e-6), PlateSection(169e9, 0.3, T), "free", 1e-7)
    points = np.array([[-150e-6, -90e-6], [140e-6, -100e-6], [20e-6, 110e-6], [-20e-6, 10e-6]])
    shapes = plate.influence(points)
    forces = shapes.pressure_forces(Q)
    assert forces.sum() == pytest.approx(-Q * 400e-6 * 300e-6, rel=1e-9)
    assert np.abs(forces @ points).max() < 1e-9 * np.abs(forces).max() * 150e-6
    spots = np.array([[-190e-6, 140e-6], [60e-6, 0.0], [180e-6, 120e-6], [0.0, -145e-6]])
    both = np.concatenate([points, spots])
    held = shapes.under_pressure(Q).values(both / shapes.size)[:, 0]
    assert np.abs(held[:4]).max() < 1e-8 * np.abs(held).max()
    # The same forces on a plate that nothing holds bend it alike, and leave it a rigid motion.
    off = plate.deflection(points, forces, Q).evaluate(both)[0] - held
    rigid = np.column_stack([np.ones(len(both)), both])
    assert np.abs(off - rigid @ np.linalg.lstsq(rigid, off)[0]).max() < 1e-6 * np.abs(held).max()


@pytest.mark.slow
def test_a_plate_with_mass_rings_as_it_would_without_a_pressure():
    fast = CENTRE | {"frequency": 20e3}
    run = {"duration": 0.3e-3}
    plain, pressed = (build_surface(case_with(fast, run=run, inertia=True, pressure=q)) for q in (0.0, Q))
    for time in (0.0, 0.06e-3, 0.21e-3):
        state, alone = pressed.evaluate(ON, time), plain.evaluate(ON, time)
        assert np.abs(state.w - alone.w - bulge(-BULGE / GIVES)).max() < 1e-6 * BULGE
        assert np.abs(state.w_tt - alone.w_tt).max() <= 1e-7 * np.abs(alone.w_tt).max()


@pytest.mark.parametrize("inertia", [False, True])
def test_other_drives_and_other_strokes_keep_the_pressure(inertia):
    case = case_with(CENTRE, pressure=Q, inertia=inertia)
    other = case.vary({"actuators.0.stroke": "3 um"})
    expected = build_surface(other).evaluate(ON, 0.8e-3).w
    surface = build_scene(case).surface
    assert np.abs(surface.scaled(1.0, 3.0).evaluate(ON, 0.8e-3).w - expected).max() < 1e-13
    shared = shared_surface(case, [build_drives(case)], 5e-3)
    assert np.abs(shared.driven_by(build_drives(other)).evaluate(ON, 0.8e-3).w - expected).max() < 1e-13
    with pytest.raises(ValueError, match="drives must be one an actuator, 1; got 2"):
        shared.driven_by(build_drives(case) * 2)


def test_the_figures_of_a_run_count_the_pressure():
    idle = case_with(CENTRE | {"delay": 1.0}, pressure=Q)
    summary = run_case(idle).summary
    r = np.linspace(0, A, 20001)
    force = -BULGE / GIVES
    w = Q * (A**2 - r**2) ** 2 / (64 * D) + central_load(r, A, D, force)
    # They are sampled at the mesh's points.
    assert 0.97 < summary.deflection_over_thickness / (np.abs(w).max() / T) < 1 + 1e-6
    assert 0.97 < summary.largest_slope / np.abs(np.gradient(w, r)).max() < 1 + 1e-6


def test_actuators_bear_it_within_their_largest_force():
    held = Q * np.pi * A**2 / 4
    up = case_with(CENTRE | {"stroke": 0.1e-6, "max_force": held}, pressure=Q)
    down = up.vary({"actuators.0.stroke": "-0.1 um"})
    assert largest_forces(down) == pytest.approx([held + 0.1e-6 / GIVES], rel=1e-6)
    assert largest_forces(up) == pytest.approx([held], rel=1e-6)
    assert limit_warnings(down) and not limit_warnings(up)


def test_the_text_of_a_case_has_its_pressure_in_pascal(tmp_path):
    case = case_with(CENTRE, pressure=-100.0)
    file = write_case(case, tmp_path / "again.toml")
    assert 'pressure = "-100 Pa"\n' in file.read_text()
    assert read_case(file).plate == case.plate


def test_large_arrays_take_none():
    many = {"rows": 16, "columns": 16, "pitch": 20e-6, "frequency": 300.0, "stroke": 1e-6}
    with pytest.raises(InputError, match=r"plate.pressure of Case must be 0 with more than 250 actuators.* got 256"):
        Case(
            plate=PLATE | {"pressure": 100.0},
            lattice=many,
            part={"mass": 1e-12, "position": (105e-6, 20e-6)},
            friction={"model": "constant", "limit": 1e-6},
            run={"duration": 5e-3},
        )
