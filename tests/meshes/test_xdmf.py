"""XDMF meshes whose numbers are in files of their own, which may lie, be damaged or have no end."""

import h5py
import meshio
import numpy as np
import pytest

from meshes import hdf5, read, rectangle, xdmf


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


def test_numbers_that_are_no_hdf5(mesh):
    mesh.with_suffix(".h5").write_text("text")
    assert "mesh.h5 is no HDF5 file, or is damaged" in refused(mesh)


def test_numbers_of_which_few_are_stored(mesh):
    with h5py.File(mesh.with_suffix(".h5"), "r+") as file:
        del file["data0"]
        file.create_dataset("data0", (10**11, 3), "f8", chunks=(1000, 3))
    assert "its data0 says that it has 2400000000000 bytes" in refused(mesh)


def test_numbers_elsewhere(mesh):
    with h5py.File(mesh.with_suffix(".h5"), "r+") as file:
        del file["data0"]
        file["data0"] = h5py.ExternalLink("/etc/passwd", "/")
    assert "its data0 is a link" in refused(mesh)


def test_numbers_on_which_the_library_would_die(mesh, monkeypatch):
    monkeypatch.setattr(xdmf, "survives", lambda path: False)
    assert f"mesh.h5 is damaged: {hdf5.DEADLY}" in refused(mesh)


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
