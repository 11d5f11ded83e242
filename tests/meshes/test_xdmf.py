"""XDMF meshes whose numbers are in files of their own, which may lie, be damaged or have no end."""

import re

import h5py
import meshio
import numpy as np
import pytest

import common
from meshes import read, rectangle


@pytest.fixture
def mesh(tmp_path):
    """An XDMF mesh, its numbers in mesh.h5."""
    plate = rectangle(600e-6, 400e-6, cell_size=100e-6)
    lines = np.concatenate([np.asarray(facets) for facets in plate.boundaries.values()])
    numbers = np.repeat(np.arange(1, 1 + len(plate.boundaries)), [len(facets) for facets in plate.boundaries.values()])
    cells = [("line", lines), ("triangle", plate.triangles)]
    data = {"boundary": [numbers, np.zeros(len(plate.triangles), int)]}
    path = tmp_path / "mesh.xdmf"
    meshio.Mesh(np.pad(plate.points, ((0, 0), (0, 1))), cells, cell_data=data).write(path)
    return path


def changed(path, name, change):
    with h5py.File(path.with_suffix(".h5"), "r+") as file:
        values = change(file[name][()])
        del file[name]
        file[name] = values


def refused(path):
    with pytest.raises(ValueError, match=r"Input path of read must be a mesh file whose numbers can be read") as error:
        read(path)
    assert str(path) in str(error.value)
    return str(error.value)


def test_numbers_in_hdf5_are_read(mesh):
    assert len(read(mesh).points) > 10


def test_numbers_that_are_not_there(mesh):
    mesh.with_suffix(".h5").unlink()
    assert refused(mesh).count("mesh.h5") == 1  # of several arrays
    assert f"{mesh.with_suffix('.h5')} is missing" in refused(mesh)


def test_a_dataset_that_is_not_there(mesh):
    with h5py.File(mesh.with_suffix(".h5"), "r+") as file:
        del file["data0"], file["data2"]
        file.create_group("data2")
    lacking = f"{mesh.with_suffix('.h5')} has no data set"
    assert refused(mesh).endswith(f"\n  {lacking} data0\n  {lacking} data2")
    mesh.write_text(mesh.read_text().replace("mesh.h5:/data0", "mesh.h5"))
    assert "mesh.h5 is named without a data set after a colon" in refused(mesh)


def lists_of_numbers(xy):
    rows = np.empty(len(xy), h5py.vlen_dtype(float))
    rows[:] = list(xy)
    return rows


@pytest.mark.parametrize(
    ("name", "change", "wrong"),
    [
        ("data0", lambda xy: xy + 1j, "those of {} are complex numbers"),
        ("data0", lambda xy: xy.astype("S8"), "those of {} are text"),
        ("data0", lambda xy: xy.astype(str).astype(object), "those of {} are text or lists"),
        ("data0", lists_of_numbers, "those of {} are text or lists"),
        ("data0", lambda xy: np.zeros(len(xy), [("x", "f8"), ("y", "f8")]), "those of {} are no numbers"),
        ("data0", lambda xy: xy[:, 0], "those of {} are numbers in the shape (35,)"),
        ("data1", lambda rows: rows + 0.5, "are rows of 3 whole numbers; those of {} are not"),
        ("data1", lambda rows: rows + 1j, "are rows of 3 whole numbers; those of {} are not"),
        ("data1", lambda rows: rows[:, :2], "are rows of 3 whole numbers; those of {} are not"),
    ],
)
def test_numbers_of_other_kinds(mesh, name, change, wrong):
    old = meshio.read(mesh)
    meshio.Mesh(old.points, [("triangle", old.cells_dict["triangle"])]).write(mesh)
    changed(mesh, name, change)
    with pytest.raises(ValueError, match=re.escape(wrong.format(mesh))) as error:
        read(mesh)
    assert "\n" not in str(error.value)


def test_an_unnamed_boundary_is_told_without_gmsh(mesh):
    changed(mesh, "data2", lambda numbers: numbers.astype(float))
    with pytest.raises(ValueError, match="give them lines, with a whole number each in the cell data boundary"):
        read(mesh)


def test_numbers_of_boundaries_in_a_column(mesh):
    names = list(read(mesh).boundaries)
    changed(mesh, "data2", lambda numbers: numbers[:, None])
    assert list(read(mesh).boundaries) == names
    changed(mesh, "data2", lambda numbers: numbers.repeat(2, axis=1))
    with pytest.raises(ValueError, match="an unnamed boundary"):
        read(mesh)


def test_numbers_that_are_no_hdf5(mesh):
    mesh.with_suffix(".h5").write_text("text")
    assert "mesh.h5 is no HDF5 file, or is damaged" in refused(mesh)


def test_numbers_of_which_few_are_stored(mesh):
    with h5py.File(mesh.with_suffix(".h5"), "r+") as file:
        del file["data0"]
        file.create_dataset("data0", (10**11, 3), "f8", chunks=(1000, 3))
    assert "its data0 says that it has 2400000000000 bytes" in refused(mesh)


def test_numbers_of_which_none_are_stored(mesh):
    changed(mesh, "data0", lambda _: h5py.Empty("f8"))
    assert refused(mesh).endswith("mesh.h5 is refused: its data0 is empty")


def test_numbers_elsewhere(mesh):
    with h5py.File(mesh.with_suffix(".h5"), "r+") as file:
        del file["data0"]
        file["data0"] = h5py.ExternalLink("/etc/passwd", "/")
    assert "its data0 is a link" in refused(mesh)


def test_numbers_on_which_the_library_would_die(mesh, monkeypatch):
    monkeypatch.setattr(common, "survives", lambda path: False)
    assert f"mesh.h5 is damaged: {common.DEADLY}" in refused(mesh)


def test_large_numbers(mesh, monkeypatch):
    monkeypatch.setattr("meshes.files.MAX_SIZE", 3000)
    assert "at most 3000 are read" in refused(mesh)


def test_raw_numbers_of_a_device(mesh):
    text = mesh.read_text()
    first = text.index("mesh.h5:")
    mesh.write_text(
        text.replace('Format="HDF"', 'Format="Binary"', 1).replace(text[first:].split("<")[0], "/dev/zero", 1)
    )
    assert "/dev/zero is a folder, a pipe or a device, not a file" in refused(mesh)
