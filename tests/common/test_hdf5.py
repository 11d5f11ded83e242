"""HDF5 files that lie about what they hold."""

import os
import signal
import time

import h5py
import numpy as np
import pytest

from common import check_hdf5, hdf5, survives


def huge(file):
    file.create_dataset("huge", (10**12,), "f8", chunks=(1000,))


def uncompressed(file):
    file.create_dataset("huge", (10**12,), "f8", compression="gzip", chunks=(1000,))[:1000] = 1.0


def elsewhere(file):
    file["elsewhere"] = h5py.ExternalLink("/etc/passwd", "/")


def soft(file):
    file["elsewhere"] = h5py.SoftLink("/nowhere")


def external(file):
    file.create_dataset("elsewhere", (10,), "u1", external=[("/etc/passwd", 0, 10)])


def virtual(file):
    layout = h5py.VirtualLayout((10,), "f8")
    layout[:] = h5py.VirtualSource("other.h5", "x", (10,))
    file.create_virtual_dataset("elsewhere", layout)


@pytest.mark.parametrize(
    "make", [huge, uncompressed, elsewhere, soft, external, virtual], ids=lambda make: make.__name__
)
def test_what_is_not_there_is_refused_before_it_is_read(tmp_path, make):
    with h5py.File(tmp_path / "file.h5", "w") as file:
        file["right"] = np.zeros(10)
        make(file)
    with pytest.raises(ValueError, match="its (huge says|elsewhere is)"):
        check_hdf5(tmp_path / "file.h5")


def test_zeros_may_be_packed_and_groups_may_hold_themselves(tmp_path):
    with h5py.File(tmp_path / "file.h5", "w") as file:
        file.create_dataset("zeros", data=np.zeros(2_000_000), compression="gzip")
        file["group/itself"] = file.create_group("group/inner")
        file["group/above"] = file["group"]
    check_hdf5(tmp_path / "file.h5")


def crash():
    os.kill(os.getpid(), signal.SIGKILL)


def circle():
    time.sleep(60)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork here")
@pytest.mark.parametrize(
    "harm", [lambda: os.kill(os.getpid(), signal.SIGKILL), lambda: time.sleep(60)], ids=["crash", "circle"]
)
def test_a_file_on_which_the_library_dies_is_found_out(tmp_path, monkeypatch, harm):
    with h5py.File(tmp_path / "file.h5", "w") as file:
        file["right"] = np.zeros(10)
    assert survives(tmp_path / "file.h5")
    (tmp_path / "text.h5").write_text("no HDF5")
    assert survives(tmp_path / "text.h5")
    monkeypatch.setattr(hdf5, "_read_all", lambda path: harm())
    monkeypatch.setattr(hdf5, "PATIENCE", 0.2)
    assert not survives(tmp_path / "file.h5")


@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork here")
def test_attributes_are_tried_before_a_link_that_is_refused(tmp_path, monkeypatch):
    with h5py.File(tmp_path / "file.h5", "w") as file:
        file.attrs["kind"], file["elsewhere"] = "x", h5py.SoftLink("/nowhere")
    monkeypatch.setattr(h5py.AttributeManager, "__getitem__", lambda *_: os.kill(os.getpid(), signal.SIGKILL))
    assert not survives(tmp_path / "file.h5")


@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork here")
def test_a_file_that_takes_too_much_memory_is_not_read(tmp_path, monkeypatch):
    (tmp_path / "file.h5").touch()
    monkeypatch.setattr(hdf5, "_read_all", lambda path: np.ones(3 * 10**8 // 8))
    assert survives(tmp_path / "file.h5")
    monkeypatch.setattr(hdf5, "MEMORY", 10**8)
    assert not survives(tmp_path / "file.h5")


def other_axes(name, value):
    def change(file):
        scale, rows = file.create_dataset("scale", data=np.zeros(3)), file.create_dataset("rows", data=np.zeros(3))
        scale.make_scale("x")
        rows.dims[0].attach_scale(scale)
        del file["rows" if name == "DIMENSION_LIST" else "scale"].attrs[name]
        file["rows" if name == "DIMENSION_LIST" else "scale"].attrs[name] = value

    return change


@pytest.mark.parametrize("value", [5, "x", [1, 2, 3], h5py.Empty("f8")], ids=str)
@pytest.mark.parametrize("name", ["DIMENSION_LIST", "REFERENCE_LIST"])
def test_axes_in_another_form_are_refused(tmp_path, name, value):
    path = tmp_path / "file.h5"
    with h5py.File(path, "w") as file:
        other_axes(name, value)(file)
    of = "rows" if name == "DIMENSION_LIST" else "scale"
    with pytest.raises(ValueError, match=f"its {of} names its axes in another form than netCDF"):
        check_hdf5(path)
