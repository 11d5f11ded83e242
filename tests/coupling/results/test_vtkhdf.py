"""The result files: what VTK reads back from them, at each step, in good ends and in bad ones."""

import json
import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import h5py  # type: ignore[import-untyped]
import numpy as np
import pytest
import pyvista as pv
from vtkhdf_files import (
    N_STEPS,
    POINTS,
    TIMES,
    TRIANGLES,
    bump,
    gradient,
    names,
    part_fields,
    position,
    step_in_vtk,
    times_in_vtk,
)
from vtkmodules.vtkIOHDF import vtkHDFReader

from coupling.results import vtkhdf

ROOT = Path(vtkhdf.__file__).parents[2]


def write_plate(directory: Path, steps: int = N_STEPS, first: int = 0) -> None:
    with vtkhdf.plate_file(directory, "run", POINTS, TRIANGLES) as plate:
        for k in range(first, first + steps):
            plate.append(TIMES[k], deflection=bump(k), gradient=gradient(k))


def write_part(directory: Path, steps: int = N_STEPS) -> None:
    with vtkhdf.part_file(directory, "run") as part:
        for k in range(steps):
            part.append(TIMES[k], position(k), **part_fields(k))


def assert_plate_step(path: Path, step: int) -> None:
    mesh = step_in_vtk(path, step)
    np.testing.assert_array_equal(mesh.points, np.column_stack([POINTS, np.zeros(len(POINTS))]))
    np.testing.assert_array_equal(mesh.cells_dict[pv.CellType.TRIANGLE], TRIANGLES)
    assert mesh.point_data.keys() == ["deflection", "gradient"]
    np.testing.assert_array_equal(mesh["deflection"], bump(step))
    np.testing.assert_array_equal(mesh["gradient"], gradient(step))


def assert_part_step(path: Path, step: int) -> None:
    mesh = step_in_vtk(path, step)
    np.testing.assert_array_equal(mesh.points, [position(step)])
    assert mesh.n_cells == 1
    for name, value in part_fields(step).items():
        np.testing.assert_array_equal(mesh[name], [value])
    assert mesh["state"].dtype == np.int64


def test_vtk_reads_every_step_of_the_plate(tmp_path: Path) -> None:
    write_plate(tmp_path)
    path = tmp_path / "run.plate.vtkhdf"
    assert names(tmp_path) == [path.name]
    assert times_in_vtk(path) == TIMES
    for step in range(N_STEPS):
        assert_plate_step(path, step)


def test_vtk_reads_every_step_of_the_part(tmp_path: Path) -> None:
    write_part(tmp_path)
    path = tmp_path / "run.part.vtkhdf"
    assert names(tmp_path) == [path.name]
    assert times_in_vtk(path) == TIMES
    for step in range(N_STEPS):
        assert_part_step(path, step)


def test_a_pipeline_that_asks_for_a_time_gets_the_step_of_that_time(tmp_path: Path) -> None:
    write_part(tmp_path)
    reader = vtkHDFReader()
    reader.SetFileName(str(tmp_path / "run.part.vtkhdf"))
    for step in (13, 2, 19):
        reader.UpdateTimeStep(TIMES[step])
        assert reader.GetOutput().GetPoint(0) == position(step)
        assert reader.GetOutput().GetNumberOfVerts() == 1


def test_vtk_reads_a_file_of_one_step(tmp_path: Path) -> None:
    write_plate(tmp_path, steps=1)
    write_part(tmp_path, steps=1)
    assert_plate_step(tmp_path / "run.plate.vtkhdf", 0)
    assert_part_step(tmp_path / "run.part.vtkhdf", 0)


def test_points_with_a_height_keep_it(tmp_path: Path) -> None:
    points = np.column_stack([POINTS, np.linspace(0.0, 1e-3, len(POINTS))])
    with vtkhdf.plate_file(tmp_path, "run", points, TRIANGLES) as plate:
        plate.append(0.0, deflection=bump(0))
    np.testing.assert_array_equal(step_in_vtk(tmp_path / "run.plate.vtkhdf", 0).points, points)


def test_integers_truth_values_and_float32_keep_their_values(tmp_path: Path) -> None:
    contact = np.arange(len(POINTS)) % 2 == 0
    with vtkhdf.plate_file(tmp_path, "run", POINTS, TRIANGLES) as plate:
        plate.append(0.0, deflection=bump(3).astype(np.float32), contact=contact, count=np.arange(len(POINTS)))
    mesh = step_in_vtk(tmp_path / "run.plate.vtkhdf", 0)
    assert [mesh[name].dtype for name in ("deflection", "contact", "count")] == [np.float32, np.int64, np.int64]
    np.testing.assert_array_equal(mesh["deflection"], bump(3).astype(np.float32))
    np.testing.assert_array_equal(mesh["contact"], contact)
    np.testing.assert_array_equal(mesh["count"], np.arange(len(POINTS)))


def test_metadata_of_start_and_end_are_outside_the_vtk_group(tmp_path: Path) -> None:
    case = "plate: µm\n" * 20_000
    with vtkhdf.part_file(tmp_path, "run", {"case": case, "status": "running", "seed": 3}) as part:
        part.append(0.0, position(0))
        part.add_metadata({"summary": json.dumps({"slips": 2}), "status": "finished", "wall_time": 1.5})
    with h5py.File(tmp_path / "run.part.vtkhdf") as file:
        stored = dict(file["active_surface"].attrs)
    assert stored == {"case": case, "seed": 3, "summary": '{"slips": 2}', "status": "finished", "wall_time": 1.5}


CHILD = """
import sys
sys.path[:0] = sys.argv[2:]
from vtkhdf_files import *
from coupling.results import vtkhdf
vtkhdf.FLUSH_AFTER = 0.0
with vtkhdf.plate_file(sys.argv[1], "run", POINTS, TRIANGLES, {"case": "text"}) as plate, \\
        vtkhdf.part_file(sys.argv[1], "run") as part:
    for k in range(N_STEPS - 1):
        plate.append(TIMES[k], deflection=bump(k), gradient=gradient(k))
        part.append(TIMES[k], position(k), **part_fields(k))
    print("written", flush=True)
    sys.stdin.read()
"""


def test_a_kill_leaves_partial_files_with_the_flushed_steps(tmp_path: Path) -> None:
    command = [sys.executable, "-c", CHILD, str(tmp_path), str(ROOT / "tests" / "reference"), str(ROOT)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as child:
        assert child.stdout is not None and child.stdout.readline() == "written\n"
        os.kill(child.pid, signal.SIGKILL)
    assert child.returncode == -signal.SIGKILL
    plate, part = tmp_path / "run.partial.plate.vtkhdf", tmp_path / "run.partial.part.vtkhdf"
    assert names(tmp_path) == [part.name, plate.name]
    for path, assert_step in ((plate, assert_plate_step), (part, assert_part_step)):
        assert times_in_vtk(path) == TIMES[:-1]
        for step in range(N_STEPS - 1):
            assert_step(path, step)
    with h5py.File(plate) as file:
        assert file["active_surface"].attrs["case"] == "text"


def test_steps_are_flushed_at_least_every_half_second(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    clock = [100.0]
    monkeypatch.setattr(vtkhdf.time, "monotonic", lambda: clock[0])
    flushed = 0.0
    with vtkhdf.part_file(tmp_path, "run") as part:
        for k in range(N_STEPS):
            part.append(TIMES[k], position(k))
            with h5py.File(shutil.copy(tmp_path / "run.partial.part.vtkhdf", tmp_path / "as a kill leaves it")) as file:
                if file["VTKHDF/Steps"].attrs["NSteps"] == k + 1:
                    flushed = clock[0]
            assert clock[0] - flushed < 0.5
            clock[0] += 0.1


def test_steps_written_together_are_those_written_one_by_one(tmp_path: Path) -> None:
    write_plate(tmp_path)
    write_part(tmp_path)
    steps = range(N_STEPS)
    together = tmp_path / "together"
    together.mkdir()
    with vtkhdf.plate_file(together, "run", POINTS, TRIANGLES) as plate, vtkhdf.part_file(together, "run") as part:
        for some in (steps[first : first + 3] for first in range(0, N_STEPS, 3)):
            times = [TIMES[k] for k in some]
            fields = [part_fields(k) for k in some]
            plate.append(times, deflection=[bump(k) for k in some], gradient=[gradient(k) for k in some])
            part.append(times, [position(k) for k in some], **{n: [one[n] for one in fields] for n in fields[0]})
    for name in ("run.plate.vtkhdf", "run.part.vtkhdf"):
        with h5py.File(tmp_path / name) as one, h5py.File(together / name) as other:
            assert everything(one) == everything(other)


def everything(file: h5py.File) -> dict[str, object]:
    """All attributes and datasets by their places: types, shapes and bytes."""
    found: dict[str, object] = {}

    def note(name: str, what: h5py.HLObject) -> None:
        found.update({f"{name}@{key}": np.array(value).tobytes() for key, value in what.attrs.items()})
        if isinstance(what, h5py.Dataset):
            found[name] = (what.dtype, what.shape, what.chunks, what[()].tobytes())

    file.visititems(note)
    return found


def test_there_are_as_many_times_as_steps_between_flushes_too(tmp_path: Path) -> None:
    """VTK overruns a buffer where Values is longer than NSteps, and HDF5 may write to disk whenever it likes."""
    with vtkhdf.part_file(tmp_path, "run") as part:
        for k in range(N_STEPS):
            part.append(TIMES[k], position(k))
            steps = part._file["VTKHDF/Steps"]  # what HDF5 holds in memory
            assert len(steps["Values"]) == steps.attrs["NSteps"]


def test_an_exception_leaves_the_steps_so_far_and_the_old_result(tmp_path: Path) -> None:
    write_plate(tmp_path, steps=3)
    old = (tmp_path / "run.plate.vtkhdf").read_bytes()
    said = r"^interrupted; .*run\.partial\.plate\.vtkhdf has the steps so far$"
    with pytest.raises(KeyboardInterrupt, match=said), vtkhdf.plate_file(tmp_path, "run", POINTS, TRIANGLES) as plate:
        for k in range(11):
            plate.append(TIMES[k], deflection=bump(k), gradient=gradient(k))
        raise KeyboardInterrupt
    partial = tmp_path / "run.partial.plate.vtkhdf"
    assert names(tmp_path) == [partial.name, "run.plate.vtkhdf"]
    assert (tmp_path / "run.plate.vtkhdf").read_bytes() == old
    assert times_in_vtk(partial) == TIMES[:11]
    for step in range(11):
        assert_plate_step(partial, step)


def test_a_rerun_replaces_the_partial_and_the_final_file(tmp_path: Path) -> None:
    write_plate(tmp_path, steps=5)
    with pytest.raises(RuntimeError), vtkhdf.plate_file(tmp_path, "run", POINTS, TRIANGLES) as plate:
        plate.append(TIMES[9], deflection=bump(9))
        raise RuntimeError
    write_plate(tmp_path, steps=2, first=4)
    assert names(tmp_path) == ["run.plate.vtkhdf"]
    assert times_in_vtk(tmp_path / "run.plate.vtkhdf") == TIMES[4:6]
    reread = step_in_vtk(tmp_path / "run.plate.vtkhdf", 1)
    np.testing.assert_array_equal(reread["deflection"], bump(5))
