"""The case: values in SI units, from files and in Python, and cases with other values."""

from __future__ import annotations

import pickle
import re
from pathlib import Path

import numpy as np
import pytest
from case_files import GOOD, TEXTS, changed, plate, python_case, read
from pydantic import ValidationError

from coupling.case import (
    ActuatorCase,
    Case,
    ConstantCase,
    CoulombCase,
    InputError,
    KogutEtsionCase,
    PartCase,
    RunCase,
    common_period,
    find_field,
)
from coupling.scene import damping_of
from coupling.stretch.schedule import schedule_of
from particle import Drive

FRICTION = 'model = "kogut-etsion"'


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
    assert (case.plate.theory, case.plate.inertia, case.plate.damping) == ("linear", False, 0.02)
    first = case.actuators[0]
    assert (first.cycle, first.cycles, first.delay) == ("up-down", None, 0.0)
    assert (case.part.velocity, case.part.size, case.part.squeeze) == ((0.0, 0.0), None, 0.0)
    assert (case.run.gravity, case.run.tolerance, case.run.frames, case.run.start) == (9.80665, 1e-9, None, "rest")
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
    radius, place, duration = 'radius = "300 um"', 'position = ["100 um", "100 um"]', 'duration = "50 ms"'
    case = read(
        tmp_path,
        changed(
            (radius, radius + '\nsupports = "clamped"\ndensity = "2.33 g/cm^3"\ncell_size = "300 µm"'),
            ("poisson_ratio = 0.3", "poisson_ratio = 0"),
            ('stroke = "150 um"', 'stroke = "0 um"\ncycle = "up"'),
            (place, place + '\nvelocity = ["1 mm/s", "-2 mm/s"]\nsize = "100 um"'),
            (duration, duration + '\ngravity = "-1 m/s²"\ntolerance = 1e-2\nframes = 2'),
        ),
    )
    assert case.plate.density == pytest.approx(2330)
    assert (case.plate.cell_size, case.plate.poisson_ratio) == (300e-6, 0)
    assert (case.actuators[0].stroke, case.actuators[0].cycle) == (0, "up")
    assert (case.part.velocity, case.part.size) == ((1e-3, -2e-3), 100e-6)
    assert (case.run.gravity, case.run.tolerance, case.run.frames) == (-1, 1e-2, 2)
    options = 'gravity = ["0 m/s^2", "100 cm/s^2", "-9.8 m/s^2"]\nafter_detachment = "fly"\n'
    run = read(tmp_path, GOOD + options).run
    assert (run.gravity, run.after_detachment, run.scheme, run.time_step) == ((0.0, 1.0, -9.8), "fly", "events", None)
    run = read(tmp_path, GOOD + 'scheme = "fixed"\ntime_step = "2 us"').run
    assert (run.scheme, run.time_step) == ("fixed", 2e-6)


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


def test_building_in_python() -> None:
    case = python_case()
    assert case.actuators[0].position == (0.0, 1e-6) and case.actuators[0].stroke == 150e-6
    assert case.part.position == (1e-4, 1e-4)
    assert (case.name, case.source) == ("case", None)
    assert python_case(name="other").name == "other"
    with pytest.raises(ValidationError, match="frozen"):
        case.name = "new"


@pytest.mark.parametrize("name", ["good", "mesh", "lattice", "points", "vibrating", "wafer"])
def test_a_case_comes_back_from_its_dump_and_from_pickling(tmp_path: Path, name: str) -> None:
    text = TEXTS[name].replace('"60 um", "-60 um"', '"200 um", "60 um"') if name == "mesh" else TEXTS[name]
    case = read(tmp_path, text.replace('["60 um", "60 um"]', '["60 um", "200 um"]') if name == "mesh" else text)
    assert Case(**case.model_dump()) == case and Case.model_validate_json(case.model_dump_json()) == case
    assert pickle.loads(pickle.dumps(case)) == case


def test_arrays_and_numbers_of_numpy_are_taken_as_those_of_python() -> None:
    motion, place = np.array([[0, 0], [1e-3, 1e-6], [2e-3, 0]]), np.array([1e-5, 0])
    actuator = {"position": place, "table": motion, "repeats": np.int64(3)}
    case = python_case(actuators=[actuator], run={"duration": np.float32(0.5), "frames": np.int32(7)})
    assert case.actuators == (ActuatorCase(position=(1e-5, 0), table=tuple(map(tuple, motion.tolist())), repeats=3),)
    assert (case.run.duration, case.run.frames) == (0.5, 7)
    moved = case.vary(
        {"part.position": np.array([1e-6, 2e-6]), "actuators.0.table.1": motion[1], "run.frames": motion.size}
    )
    assert moved.part.position == (1e-6, 2e-6) and moved.actuators == case.actuators and moved.run.frames == 6


def test_a_case_is_varied() -> None:
    case = python_case(friction=CoulombCase(coefficient=0.3))  # whose class alone says which law it is
    new = case.vary({"friction.coefficient": 0.4, "actuators.*.stroke": "1 um", "part.position.1": 2e-5}, "new")
    assert (new.friction.coefficient, new.actuators[0].stroke, new.part.position) == (0.4, 1e-6, (1e-4, 2e-5))
    assert (new.name, new.source, case.vary({}).name) == ("new", None, "case")
    assert case.vary({"friction": {"model": "constant", "limit": 1e-6}}).friction == ConstantCase(limit=1e-6)


def test_the_lattice_of_a_file_is_varied_until_its_actuators_are_those_of_the_case(tmp_path: Path) -> None:
    case = read(tmp_path, TEXTS["lattice"])
    new = case.vary({"lattice.rows": 1, "lattice.stroke": "column um"})
    assert [one.stroke for one in new.actuators] == pytest.approx([0, 1e-6, 2e-6, 3e-6])
    with pytest.raises(InputError, match=r"must not vary actuators from 0 on: the changed lattice makes them anew"):
        case.vary({"lattice.rows": 1, "actuators.0.stroke": 1e-6})
    with pytest.raises(InputError, match=r"lattice.rows of Case must be a field of the case; it has no \[lattice\]"):
        new.vary({"lattice.rows": 2})


@pytest.mark.parametrize(
    "written, damping",
    [("0.1", 0.1), ("0", 0.0), ('[["20 kHz", 0.02], ["80 kHz", 0.01]]', ((20e3, 0.02), (80e3, 0.01)))],
)
def test_damping_is_a_ratio_or_pairs(tmp_path: Path, written: str, damping: object) -> None:
    case = read(tmp_path, TEXTS["vibrating"].replace("inertia = true", f"inertia = true\ndamping = {written}"))
    assert case.plate.inertia is True and case.plate.damping == damping
    assert case.plate.model_validate_json(case.plate.model_dump_json()).damping == damping  # warnings are errors
    assert read(tmp_path, TEXTS["vibrating"] + 'start = "steady"\n').run.start == "steady"


def test_a_table_of_damping_goes_on_beyond_its_ends() -> None:
    pairs = python_case().plate.model_copy(update={"damping": ((20e3, 0.02), (80e3, 0.01))})
    ratios = damping_of(pairs)(np.array([1e3, 20e3, 50e3, 80e3, 1e6]))
    assert ratios == pytest.approx([0.02, 0.02, 0.015, 0.01, 0.01], rel=1e-12)


def test_periods_that_differ_by_a_billionth_have_no_common_one() -> None:
    assert common_period(5e-4, 1e-3 / 3) == pytest.approx(1e-3, rel=1e-15)
    assert common_period(5e-4, 5e-4 * (1 + 1e-9)) == np.inf


def test_a_field_is_found_by_its_path() -> None:
    vibrating = python_case(plate=plate(density="2330 kg/m^3", inertia=True))
    field = find_field(vibrating, None, "plate.damping")
    assert (field.kind, field.unit, field.base) == ("number", "1", 0.02) and field.read(0.05) == 0.05
    with pytest.raises(ValueError, match="a ratio from 0 to below 1"):
        field.read(1.5)
    pairs = python_case(plate=plate(density="2330 kg/m^3", inertia=True, damping=[["20 kHz", 0.02], ["80 kHz", 0.01]]))
    ratio = find_field(pairs, None, "plate.damping.*.1")
    assert (ratio.unit, ratio.read(0.05)) == ("1", 0.05)
    for path, said in {
        "plate.damping": "must be a single value; got plate.damping, which is a list or table; name one in it",
        "plate.shape": "cannot be varied: plate.shape selects which other keys exist",
        "actuators[0].stroke": "got actuators[0].stroke; write actuators.0.stroke",
        "run.frames": "which a sweep does not use",
        "stroke": "the case has no stroke; did you mean actuators.*.stroke?",
        "lattice.rows": "it has no [lattice]",
        "part.size.x": "its part.size is not given",
    }.items():
        with pytest.raises(ValueError, match=re.escape(said)):
            find_field(pairs, None, path)


@pytest.mark.parametrize(
    ("frequencies", "period"),
    [
        (("2 kHz", "1.5 kHz"), None),
        (("2 kHz", "0.4 kHz", "150 Hz"), None),
        (("2 kHz", "1745.943 Hz"), "0.5"),
        (("700 Hz", "2 kHz", "1745.943 Hz"), "10"),
    ],
)
def test_a_stretching_plate_has_a_steady_state_where_its_drives_have_a_common_period(
    frequencies: tuple[str, ...], period: str | None
) -> None:
    """Without one, breakpoints were listed until memory ended."""
    actuators = [
        {"position": (f"{90 * k - 90} um", "30 um"), "stroke": "1 um", "frequency": frequency}
        for k, frequency in enumerate(frequencies)
    ]
    vibrating = plate(density="2330 kg/m^3", theory="von-karman", inertia=True)

    def made() -> Case:
        return python_case(plate=vibrating, actuators=actuators, run={"duration": "1 ms", "start": "steady"})

    if period is None:
        assert made().run.start == "steady"
        return
    with pytest.raises(InputError, match=rf"got a period of 0.572756384372228 ms, and {period} ms before") as error:
        made()
    assert f"actuators[{len(frequencies) - 1}].frequency" in str(error.value)
    drives = [Drive(1e-6, float(word)) for word in (2000.0, 1745.943)]
    assert schedule_of(drives, np.inf).loop == -1 and schedule_of(drives, 1e-3).edges[-1] == 1e-3
