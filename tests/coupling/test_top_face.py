"""Cases of parts on the top face with a centre of mass above it: keys, figures, warnings and the forces in files."""

import csv

import numpy as np
import pytest
import pyvista

from coupling import build_surface, read_surface, report, run_case, write_surface
from coupling.case import Case, CoulombCase, InputError, KogutEtsionCase
from particle import EventKind, KogutEtsion, Micropart, State, simulate

PLATE = {"shape": "disc", "radius": 1e-3, "youngs_modulus": 169e9, "poisson_ratio": 0.3, "thickness": 100e-6}
PART = {"mass": 2e-9, "position": (300e-6, 200e-6), "size": 100e-6}
pytestmark = pytest.mark.compiled


def case(friction, plate=None, part=None, **run):
    return Case(
        plate=PLATE | {"cell_size": 150e-6} | (plate or {}),
        actuators=[{"position": (0.0, 0.0), "stroke": 15e-6, "frequency": 2e3}],
        part=PART | (part or {}),
        friction=friction,
        run={"duration": 1e-3} | run,
    )


COULOMB = CoulombCase(coefficient=0.4)
CONSTANT = {"model": "constant", "limit": 8e-9}


@pytest.fixture(scope="module")
def runs():
    """On the mid-plane, on the top face, and with a centre of mass above it."""
    variants = {"mid-plane": ({"top_face": False}, {}), "top": ({}, {}), "high": ({}, {"centre_height": 40e-6})}
    return {name: run_case(case(CONSTANT, *tables)) for name, tables in variants.items()}


def test_a_case_has_the_heights_of_its_plate_and_part(runs):
    assert runs["mid-plane"].surface.half_thickness == 0.0
    assert runs["top"].surface.half_thickness == 50e-6
    contact = runs["high"].trajectory.contact_at([0.0])
    assert contact.contact[0] == pytest.approx((300e-6, 200e-6, 50e-6))
    assert contact.centre[0] == pytest.approx((300e-6, 200e-6, 90e-6))


def test_the_summary_has_the_share_of_the_heights(runs):
    shares = [runs[name].summary.top_face_share for name in ("mid-plane", "top", "high")]
    assert shares[0] == 0.0
    assert shares[2] / shares[1] == pytest.approx(90 / 50, rel=0.05)
    texts = [text for _, text in report.lines(runs["top"].summary, verbose=True)]
    assert f"top face and centre of mass add {shares[1]:.3g} times the mid-plane's pull on the part" in texts


@pytest.mark.slow
def test_a_part_that_is_too_high_tips_over():
    high = {"centre_height": 150e-6}
    tips = run_case(case(COULOMB, part=high)).summary
    assert tips.tipping > 1 and tips.tips
    assert any("tips over" in text for text in report.warnings(tips))
    contact = run_case(case(COULOMB, part=high)).trajectory.contact_at(np.linspace(0, 1e-3, 2001))
    shift = 150e-6 * np.linalg.norm(contact.friction, axis=1) / contact.normal_force
    assert tips.tipping == pytest.approx(shift.max() / 50e-6, rel=0.05)
    unknown = run_case(case(CONSTANT, part=high)).summary
    assert unknown.tipping > 1 and not unknown.tips
    assert not any("tips over" in text for text in report.warnings(unknown))
    assert any(
        text.endswith("times half the part's size, if nothing adheres")
        for _, text in report.lines(unknown, verbose=True)
    )


@pytest.mark.slow
def test_adhesion_keeps_a_part_from_tipping_over():
    """Enough of it that the part sticks: the force on it is then the same, and the pressing force larger by it."""
    high = {"centre_height": 150e-6, "size": 50e-6}
    weak, strong = (run_case(case(CoulombCase(coefficient=2.0, adhesion=f), part=high)) for f in (5e-6, 2e-5))
    assert all(run.trajectory.time_in(State.STICK) == run.trajectory.time[-1] == 1e-3 for run in (weak, strong))
    assert weak.summary.tips and any("tips over" in text for text in report.warnings(weak.summary))
    assert not strong.summary.tips and strong.summary.tipping < 0.25 * weak.summary.tipping
    assert not any("tips over" in text for text in report.warnings(strong.summary))


def test_forces_of_a_part_that_comes_off():
    """The end of contact is located just beyond it, where a rough contact has no separation."""
    rough = KogutEtsion(contact_area=1e-12)
    surface = build_surface(case(CONSTANT))
    path = simulate(surface, Micropart(2e-9, (100e-6, 50e-6)), rough, 1e-3, after_detachment="fly")
    off = [event.time for event in path.events if event.kind is EventKind.DETACHES]
    assert off
    contact = path.contact_at([0.0, off[0], path.time[-1]], rough)
    assert np.isfinite(contact.contact).all() and np.isfinite(contact.separation[0])
    flying = path.time[np.flatnonzero(path.state == State.FLIGHT)[0]]
    assert np.isnan(path.contact_at([flying + 1e-9], rough).separation).all()
    slips = [event.time for event in path.events if event.kind is EventKind.SLIPS]
    forces = np.linalg.norm(path.contact_at(slips).friction, axis=1)
    assert forces == pytest.approx(path.at(slips).friction_force, rel=1e-9)


def test_heights_are_checked():
    with pytest.raises(InputError, match="part.centre_height of Case must be at least 0"):
        case(CONSTANT, part={"centre_height": -1e-6})
    with pytest.raises(InputError, match="plate.top_face of Case must be true or false"):
        case(CONSTANT, plate={"top_face": "yes"})


def test_a_saved_surface_keeps_its_height(tmp_path):
    surface = build_surface(case(CONSTANT))
    assert read_surface(write_surface(surface, tmp_path / "s.h5")).half_thickness == 50e-6


@pytest.mark.slow
def test_forces_come_on_request(tmp_path):
    rough = KogutEtsionCase(preset="paper")
    given = case(rough, part={"centre_height": 40e-6}, frames=12)
    run_case(given, tmp_path / "without", csv=True)
    result = run_case(given, tmp_path, csv=True, forces=True)
    with (tmp_path / "case.csv").open() as file:
        rows = list(csv.DictReader(file))
    with (tmp_path / "without/case.csv").open() as file:
        plain = list(csv.DictReader(file))
    assert [{key: row[key] for key in plain[0]} for row in rows] == plain
    times = np.array([float(row["time [s]"]) for row in rows])
    contact = result.trajectory.contact_at(times, KogutEtsion.paper())
    for name, unit in (("contact", "m"), ("centre", "m"), ("normal", "1"), ("friction", "N")):
        written = np.array([[float(row[f"{name} {axis} [{unit}]"]) for axis in "xyz"] for row in rows])
        assert np.array_equal(written, getattr(contact, name))
    loads = [float(row["contact load [N]"]) - float(row["adhesion [N]"]) for row in rows]
    assert loads == pytest.approx([float(row["normal force [N]"]) for row in rows], rel=1e-9)
    reader = pyvista.get_reader(str(tmp_path / "case.part.vtkhdf")).reader
    reader.UpdateInformation()
    reader.SetStep(7)
    reader.Update()
    point = pyvista.wrap(reader.GetOutputDataObject(0))
    again = result.trajectory.contact_at([reader.GetTimeValue()], KogutEtsion.paper())
    for name in ("contact", "centre", "normal", "friction", "separation", "contact_load", "adhesion"):
        assert point[name][0] == pytest.approx(getattr(again, name)[0], rel=1e-12)
