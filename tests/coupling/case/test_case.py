"""The case file reader: values in SI units."""

from __future__ import annotations

from pathlib import Path

import pytest
from case_files import DURATION, FRICTION, GOOD, PART, POISSON, RADIUS, STROKE, changed, plate, read

from coupling.case import (
    ActuatorCase,
    Case,
    CaseError,
    ConstantCase,
    CoulombCase,
    KogutEtsionCase,
    PartCase,
    RunCase,
    read_case,
)


def test_good_file_is_read_to_si(tmp_path: Path) -> None:
    case = read(tmp_path, GOOD)
    assert case == Case(
        plate=plate(),
        actuators=(
            ActuatorCase(position=(0, 0), stroke=150e-6, frequency=300),
            ActuatorCase(position=(150e-6, 0), stroke=-10e-6, frequency=200, cycles=5, delay=1e-3),
        ),
        part=PartCase(mass=2e-9, position=(100e-6, 100e-6)),
        friction=KogutEtsionCase(),
        run=RunCase(duration=50e-3),
        name="test",
        source=GOOD,
    )


def test_defaults(tmp_path: Path) -> None:
    case = read(tmp_path, GOOD)
    assert (case.plate.supports, case.plate.density, case.plate.cell_size) == ("clamped", None, None)
    first = case.actuators[0]
    assert (first.cycle, first.cycles, first.delay) == ("up-down", None, 0.0)
    assert (case.part.velocity, case.part.size) == ((0.0, 0.0), None)
    assert (case.run.gravity, case.run.tolerance, case.run.frames) == (9.80665, 1e-9, None)
    assert case.friction.model_dump() == {
        "model": "kogut-etsion",
        "preset": None,
        "roughness": 20e-9,
        "contact_area": 1e-8,
        "hardness": 1.96133e9,
        "poisson_ratio": 0.3,
        "adhesion_energy": 1.0,
        "plasticity_index": 2.5,
        "asperity_beta": 0.0601,
        "intermolecular_distance": 0.3e-9,
        "coefficients": "printed",
    }


def test_every_key(tmp_path: Path) -> None:
    case = read(
        tmp_path,
        changed(
            (RADIUS, RADIUS + '\nsupports = "clamped"\ndensity = "2.33 g/cm^3"\ncell_size = "300 µm"'),
            (POISSON, "poisson_ratio = 0"),
            (STROKE, 'stroke = "0 um"\ncycle = "up"'),
            (PART, PART + '\nvelocity = ["1 mm/s", "-2 mm/s"]\nsize = "100 um"'),
            (DURATION, DURATION + '\ngravity = "-1 m/s²"\ntolerance = 1e-2\nframes = 2'),
        ),
    )
    assert case.plate.density == pytest.approx(2330)
    assert case.plate.cell_size == 300e-6
    assert case.plate.poisson_ratio == 0
    assert (case.actuators[0].stroke, case.actuators[0].cycle) == (0, "up")
    assert (case.part.velocity, case.part.size) == ((1e-3, -2e-3), 100e-6)
    assert (case.run.gravity, case.run.tolerance, case.run.frames) == (-1, 1e-2, 2)


@pytest.mark.parametrize(
    ("table", "expected"),
    [
        (FRICTION + '\npreset = "paper"', KogutEtsionCase(preset="paper")),
        (FRICTION + '\ncoefficients = "unrounded"', KogutEtsionCase(coefficients="unrounded")),
        ('model = "constant"\nlimit = "41.8 nN"', ConstantCase(limit=41.8e-9)),
        ('model = "constant"\nlimit = "0 N"', ConstantCase(limit=0)),
        ('model = "coulomb"\ncoefficient = 0.3', CoulombCase(coefficient=0.3, adhesion=0)),
        (
            'model = "coulomb"\ncoefficient = 0.3\nadhesion = "2 uN"\nstatic_coefficient = 0.3',
            CoulombCase(coefficient=0.3, adhesion=2e-6, static_coefficient=0.3),
        ),
    ],
)
def test_friction_models(tmp_path: Path, table: str, expected: object) -> None:
    assert read(tmp_path, changed((FRICTION, table))).friction == expected


def test_preset_sets_the_plasticity_index() -> None:
    assert KogutEtsionCase(preset="paper").plasticity_index == 4.9128
    assert KogutEtsionCase(preset="paper", coefficients="printed").coefficients == "printed"


def test_windows_text(tmp_path: Path) -> None:
    (tmp_path / "case.toml").write_bytes(("\ufeff" + GOOD.replace("\n", "\r\n")).encode())
    assert read_case(tmp_path / "case.toml").part.mass == 2e-9
    (tmp_path / "case.toml").write_bytes(GOOD.replace("\n", "\r\n").replace('"50 ms"', "50").encode())
    with pytest.raises(CaseError, match="line 31  run.duration"):
        read_case(tmp_path / "case.toml")
