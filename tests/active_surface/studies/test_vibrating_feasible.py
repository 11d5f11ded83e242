"""Feasible areas of a plate with mass: against exact frequency responses, and the quasi-static plate."""

from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from radial_vibration import RadialDisc

from active_surface.cli.program import main
from active_surface.studies.feasibility.case import _areas
from active_surface.studies.feasibility.ground import make_ground
from coupling import build_drives
from coupling.case import ActuatorCase, Case, CoulombCase, PartCase, RunCase

E, NU, DENSITY, THICKNESS, RADIUS, MASS, GRAVITY = 169e9, 0.3, 2330.0, 5e-6, 300e-6, 2e-9, 9.80665
UNIT = np.sqrt(E * THICKNESS**2 / 12 / (1 - NU**2) / DENSITY) / RADIUS**2  # rad/s
PLATE = {
    "shape": "disc", "radius": RADIUS, "youngs_modulus": E, "poisson_ratio": NU, "thickness": THICKNESS,
    "density": DENSITY, "cell_size": 60e-6,
}  # fmt: skip
DISC = RadialDisc()
FIRST = DISC.k[0] ** 2 * UNIT / (2 * np.pi)  # Hz
ADHESION = 2e-6  # N


def vibrating(frequency, stroke, inertia=True, start="steady", friction=0.1, **drive):
    run = {"start": start} if inertia else {}
    return Case(
        plate=PLATE | {"inertia": inertia},
        actuators=[ActuatorCase(position=(0.0, 0.0), stroke=stroke, frequency=frequency, **drive)],
        part=PartCase(mass=MASS, position=(90e-6, 0.0)),
        friction=CoulombCase(coefficient=friction, adhesion=ADHESION),
        run=RunCase(duration=0.1, **run),
        name="disc",
    )


def lost_rings(frequencies, amplitude):
    """The area (F,) where a sine's largest acceleration throws a part off: m (g - a) < -adhesion."""
    r = (np.arange(2000) + 0.5) / 2000
    omega = 2 * np.pi * frequencies
    w_tt = amplitude * omega**2 * np.abs(DISC.transfer(r, omega / UNIT, 0.02))
    return (MASS * (w_tt - GRAVITY) > ADHESION).T @ (2 * np.pi * r * RADIUS**2 / 2000)


@pytest.mark.slow
@pytest.mark.compiled
def test_the_curve_of_losses_has_the_resonance():
    """Of a steady sine, from half the first frequency to twice that; at FIRST it comes off nearly everywhere."""
    amplitude = 0.3 * (ADHESION / MASS + GRAVITY) / (2 * np.pi * FIRST) ** 2
    found = areas_alone(vibrating(FIRST, 2 * amplitude, cycle="cosine"), np.geomspace(0.5, 2, 31))
    truth = lost_rings(found.factors * FIRST, amplitude)
    edge = 2 * np.sqrt(np.pi * np.maximum(truth, found.spacing**2))  # cuts squares
    assert (np.abs(found.lost_area - truth) < 0.3 * edge * found.spacing).all()
    middle = found.lost_area[15]
    assert found.lost_area[0] == 0 and middle == found.lost_area.max() > 5 * found.lost_area[-1] > 0
    assert middle == found.own.lost_area


def areas_alone(case, factors):
    """At factors of a case's frequency, without the map, whose paths take much longer here."""
    drive = build_drives(case)[0]
    window = 1 / drive.frequency
    ground = make_ground(case, (factors[0], factors[-1]), (1.0, 1.0), window, 2 * window)
    return _areas(ground, window, drive.stroke_time, factors, 40)


@pytest.mark.compiled
@pytest.mark.slow
def test_without_haste_areas_are_those_of_the_quasi_static_plate():
    frequency, stroke = 1e-3 * FIRST, 60e-6
    slow, static = (
        areas_alone(vibrating(frequency, stroke, inertia), np.geomspace(0.5, 4, 4)) for inertia in (True, False)
    )
    assert (static.slipping.peak > 0).any() and (static.lost_area > 0).any()
    for name in ("slipping", "feasible"):
        mine, its = getattr(slow, name), getattr(static, name)
        assert mine.integral == pytest.approx(its.integral, rel=0.02, abs=0.01 * its.integral.max())
    assert slow.lost_area == pytest.approx(static.lost_area, rel=0.02, abs=12 * slow.spacing**2)


@pytest.mark.parametrize("plate", ["", 'theory = "von-karman"\n'])
def test_a_plate_without_inertia_has_no_steady_state(tmp_path, plate):
    """It follows its drives at once, from the start of the run on, which their delays count from."""
    text = Path("examples/one_actuator.toml").read_text()
    text = text.replace("[plate]\n", f"[plate]\n{plate}").replace("[run]\n", '[run]\nstart = "steady"\n')
    (tmp_path / "steady.toml").write_text(text)
    done = CliRunner().invoke(main, ["feasibility", str(tmp_path / "steady.toml"), "-o", str(tmp_path / "out")])
    assert done.exit_code == 2 and not (tmp_path / "out").exists()
    assert "run.start must not be given without inertia = true in [plate]" in done.output
    still = dict(vibrating(FIRST, 1e-6, inertia=False))
    with pytest.raises(ValueError, match=r"run\.start.* must not be given without inertia = true"):
        Case(**still | {"run": RunCase(duration=0.1, start="steady")})
