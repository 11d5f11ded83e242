"""Disks that fill, and files that another run writes: one error, and what was written before can be read."""

import shutil
from collections import namedtuple

import h5py
import numpy as np
import pytest

from coupling.files import SPARE, check_room
from coupling.results.vtkhdf import part_file

Usage = namedtuple("Usage", "total used free")


def write(folder, steps):
    with part_file(folder, "run") as part:
        for k in range(steps):
            part.append(float(k), np.full(3, k))
            yield k


def test_a_disk_that_fills_is_an_error_and_leaves_the_steps_so_far(tmp_path, monkeypatch):
    with pytest.raises(OSError, match=r"the results take \d.* MB are free; run.partial.part.vtkhdf has what was"):
        for k in write(tmp_path, 60):
            if k == 40:
                monkeypatch.setattr(shutil, "disk_usage", lambda _: Usage(10**9, 10**9, SPARE - 1))
    assert [file.name for file in tmp_path.iterdir()] == ["run.partial.part.vtkhdf"]
    with h5py.File(tmp_path / "run.partial.part.vtkhdf") as file:
        assert file["VTKHDF/Steps"].attrs["NSteps"] == 41
        np.testing.assert_array_equal(file["VTKHDF/Points"][:, 0], np.arange(41))


def test_a_limit_of_files_is_met_before_anything_is_written(tmp_path):
    resource = pytest.importorskip("resource")
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (SPARE, before[1]))
    try:
        with pytest.raises(OSError, match=r"the results take 2.1 MB: file too large$"):
            check_room(tmp_path, 1000)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert not list(tmp_path.iterdir())


def test_a_file_that_another_process_writes_is_left_alone(tmp_path):
    fcntl = pytest.importorskip("fcntl", reason="locks of another kind")
    path = tmp_path / "run.partial.part.vtkhdf"
    with h5py.File(path, "w") as file:
        file["x"] = 1.0
    with path.open("rb") as other:
        fcntl.flock(other, fcntl.LOCK_EX)
        with pytest.raises(BlockingIOError, match="another run is writing it"):
            next(write(tmp_path, 1))
    with h5py.File(path) as file:
        assert file["x"][()] == 1.0
