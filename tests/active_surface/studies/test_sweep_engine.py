"""The engine of sweeps: what cannot be found, memory, the length of chunks, many actuators."""

import ctypes
import gc
import re
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from sweeps import LATTICE, PLATE, PLATFORM, written

from active_surface.cli.program import main
from active_surface.studies import read_study, run_study, validity
from active_surface.studies.engine import Engine
from active_surface.studies.validity import corners
from coupling import batch, report, solved_plates


def test_a_group_that_fails_is_followed_path_by_path(tmp_path, monkeypatch):
    study = read_study(
        written(tmp_path, '[[axes]]\nfield = "part.mass"\nrange = ["1e-9 kg", "9e-9 kg"]\ncount = 9\n', PLATFORM)
    )
    whole, many = run_study(study).dataset, batch.simulate_many

    def failing(surface, parts, *rest):
        if any(abs(part.mass - 4e-9) < 1e-12 for part in parts):
            raise ZeroDivisionError("it went wrong")
        return many(surface, parts, *rest)

    monkeypatch.setattr(batch, "simulate_many", failing)
    sweep = run_study(study)
    assert sweep.dataset["mistakes"].values.tolist() == [0, 0, 0, 1, 0, 0, 0, 0, 0]
    assert sweep.first_refused == ["its path cannot be found: it went wrong"]
    others = np.arange(9) != 3
    assert sweep.dataset["end_x"].values[others].tobytes() == whole["end_x"].values[others].tobytes()


@pytest.mark.slow
@pytest.mark.compiled
def test_a_plate_that_cannot_be_solved_is_refused_with_the_reason(tmp_path, monkeypatch):
    solved = solved_plates.build_scene

    def failing(case, *rest):
        if case.plate.thickness < 1e-6:
            raise ZeroDivisionError("float division by zero")
        return solved(case, *rest)

    monkeypatch.setattr(solved_plates, "build_scene", failing)
    axes = '[[axes]]\nfield = "plate.thickness"\nvalues = [{}]\n'
    sweep = run_study(read_study(written(tmp_path, axes.format('"1e-9 m", "5 um"'))))
    assert sweep.dataset["mistakes"].values.tolist() == [1, 0]
    assert sweep.first_refused == ["what the part moves over cannot be made: float division by zero"]
    path = written(tmp_path, axes.format('"1e-9 m", "2e-9 m"'))
    done = CliRunner().invoke(main, ["sweep", str(path), "-o", str(tmp_path / "out")])
    assert done.exit_code == 1 and ": what the part moves over cannot be made" in done.output


def test_what_is_wrong_with_a_length_is_told_with_its_unit(tmp_path):
    study = read_study(written(tmp_path, '[[axes]]\nfield = "plate.radius"\nvalues = ["10 um", "300 um"]\n'))
    assert Engine(study).faults(0)[0].endswith("smallest width, 10 um; got 80 um")


def memory():
    """Bytes that this process has in memory, without those that the C library keeps for the next request."""
    gc.collect()
    with suppress(OSError, AttributeError):  # glibc's
        ctypes.CDLL(None).malloc_trim(0)
    return int(Path("/proc/self/statm").read_text().split()[1]) * 4096


@pytest.mark.slow
@pytest.mark.compiled
@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="reads /proc")
def test_memory_does_not_grow_with_plates(tmp_path):
    axes = '[[axes]]\nfield = "plate.thickness"\nrange = ["5 um", "6 um"]\ncount = 14\n'
    made = Engine(read_study(written(tmp_path, axes, PLATE.replace("5 ms", "10 us"))))
    made.records(range(2))
    before = memory()
    made.records(range(2, 14))
    assert memory() - before < 40e6  # 12 plates that are not given up take 65 to 100 MB


def test_plates_that_come_again_are_solved_once(tmp_path, monkeypatch):
    axes = '[[axes]]\nfield = "plate.motion.x.stroke"\nvalues = ["5 um", "6 um", "7 um", "8 um", "9 um", "10 um"]\n'
    made, build = [], solved_plates.build_scene
    monkeypatch.setattr(solved_plates, "build_scene", lambda *of: made.append(of) or build(*of))
    one = Engine(read_study(written(tmp_path, f'sampling = "random"\npoints = 40\nseed = 1\n{axes}', PLATFORM)))
    for k in range(40):
        one.records([k])
    assert len(made) == 6
    drawn = axes.replace("values", "range").replace(', "6 um", "7 um", "8 um", "9 um"', "")
    one = Engine(read_study(written(tmp_path, f'sampling = "random"\npoints = 40\n{drawn}', PLATFORM)))
    one.records(range(40))
    assert len(one._plates._scenes) == 1


@pytest.mark.parametrize(
    ("field", "low", "high"),
    [("run.duration", "20 us", "2 s"), ("plate.motion.x.frequency", "2 Hz", "100 kHz"), ("part.mass", "1 ug", "2 ug")],
)
def test_chunks_are_as_long_as_the_longest_of_their_paths_lets_them_be(tmp_path, field, low, high):
    axes = f'[[axes]]\nfield = "{field}"\nrange = ["{low}", "{{}}"]\ncount = 5000\n'
    case = PLATFORM.replace('"200 Hz"', '"2 Hz"').replace('"2 ms"', '"20 us"' if field == "run.duration" else '"10 ms"')
    case = re.sub(r'frequency = "2 Hz"', 'frequency = "200 Hz"', case) if field == "run.duration" else case
    short, long = (
        Engine(read_study(written(tmp_path, axes.format(to), case))).chunk_length
        for to in (f"{low[:-3]}1{low[-3:]}", high)
    )
    assert long < short / 20 if field != "part.mass" else long == short


@pytest.mark.slow
def test_ten_thousand_actuators_are_varied_at_once(tmp_path):
    case = LATTICE.replace("rows = 1", "rows = 100").replace("columns = 3", "columns = 100")
    case = case.replace('pitch = "100 um"', 'pitch = "2 um"').replace('"5 * (1 + column) um"', '"5 um"')
    study = read_study(
        written(tmp_path, '[[axes]]\nfield = "actuators.*.stroke"\nrange = ["1 um", "2 um"]\ncount = 9\n', case)
    )
    cases = [study.case_at((stroke * 1e-6,)) for stroke in (1.1, 1.2, 1.3)]
    assert [{actuator.stroke for actuator in made.actuators} for made in cases] == [{1.1e-6}, {1.2e-6}, {1.3e-6}]
    assert len({actuator.position for actuator in cases[0].actuators}) == len(cases[0].actuators) == 10_001
    assert cases[0].actuators[7].position == study.case.actuators[7].position


SOFT = '[[axes]]\nfield = "actuators.*.stroke"\nvalues = ["1 um", "60 um", "0.1 um"]\n'


@pytest.mark.slow
@pytest.mark.compiled
def test_the_command_warns_where_the_model_stops_holding(tmp_path):
    case = PLATE.replace('"60 um"', '"0.1 um"')
    warning, slope, strain = run_study(read_study(written(tmp_path, SOFT, case))).warnings
    assert slope.startswith("The surface is as steep as ")
    assert strain.startswith("The plate is strained by ")
    assert re.match(r"The plate deflects by 1\d(\.\d)? times its thickness", warning)
    done = CliRunner().invoke(main, ["sweep", str(written(tmp_path, SOFT, case)), "-o", str(tmp_path / "out")])
    assert f"warning     {warning}\n" in done.output
    assert run_study(read_study(written(tmp_path, SOFT.replace('"1 um", "60 um"', '"0.2 um"'), case))).warnings == []


@pytest.mark.compiled
@pytest.mark.parametrize("highest", [1e-6, 1.0])
def test_a_corner_that_cannot_be_checked_is_a_warning(tmp_path, monkeypatch, ran, highest):
    def checked(case):
        if case.actuators[0].stroke < highest:
            raise ValueError("its numbers are too far apart")
        return ran("linear").summary

    study = read_study(written(tmp_path, SOFT, PLATE))
    monkeypatch.setattr(Engine, "scene", lambda engine, case: None)
    monkeypatch.setattr(validity, "quick_summary", lambda case, scene: checked(case))
    monkeypatch.setattr(validity, "_figures", lambda engine, case: vars(checked(case)))
    *_, warning = warnings = validity.model_warnings(Engine(study))
    assert len(warnings) == (1 if highest == 1.0 else 1 + len(report.warnings(ran("linear").summary)))
    assert warning == "The model could not be checked at a corner of the axes: its numbers are too far apart."


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ('[[axes]]\nfield = "part.mass"\nvalues = ["2e-9 kg", "3e-9 kg", "1e-9 kg"]\n', [2, 1]),
        ('sampling = "list"\n[[axes]]\nfield = "part.mass"\nvalues = ["2e-9 kg", "3e-9 kg", "1e-9 kg"]\n', [2, 1]),
        (
            '[[axes]]\nfield = "part.mass"\nvalues = ["1e-9 kg", "2e-9 kg", "3e-9 kg"]\n'
            '[[axes]]\nfield = "actuators.0.cycle"\nvalues = ["up-down", "up"]\n',
            [0, 1, 4, 5],
        ),
        ('[[axes]]\nfield = "part.mass"\nvalues = ["1e-9 kg"]\n', [0]),
    ],
)
def test_corners_have_the_least_and_the_greatest_values(tmp_path, text, expected):
    assert corners(read_study(written(tmp_path, text)).points) == expected
