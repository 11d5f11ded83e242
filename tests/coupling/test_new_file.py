"""HDF5 files on a disk that fills while they are written: an error, no crash, and what was flushed can be read."""

from __future__ import annotations

import errno
import multiprocessing
import signal
import sys
from multiprocessing.connection import Connection
from pathlib import Path

import h5py
import numpy as np
import pytest

from coupling import NewFile, Sink
from coupling.results import vtkhdf

STEPS = 60


def written(path: Path, kind: type[h5py.File]) -> None:
    noise = np.random.default_rng(1).normal(size=(STEPS, 500))
    with kind(path, "w") if kind is h5py.File else kind(path) as file:
        rows = file.create_dataset("rows", (0, 500), "f8", maxshape=(None, 500), chunks=(1, 500), compression="gzip")
        for k in range(STEPS):
            rows.resize(k + 1, axis=0)
            rows[k] = noise[k]
            if k % 10 == 9:
                file.flush()


def test_the_bytes_are_those_that_hdf5_writes_itself(tmp_path: Path) -> None:
    (tmp_path / "one").write_bytes(b"older and longer" * 100_000)
    written(tmp_path / "one", NewFile)
    written(tmp_path / "other", h5py.File)
    assert (tmp_path / "one").read_bytes() == (tmp_path / "other").read_bytes()


def test_a_file_that_is_being_written_is_left_alone(tmp_path: Path) -> None:
    with NewFile(tmp_path / "file") as file:
        file["x"] = 1.0
        file.flush()
        with pytest.raises(BlockingIOError):
            NewFile(tmp_path / "file")
        file["y"] = 2.0
    with h5py.File(tmp_path / "file") as file:
        assert file["x"][()] == 1.0 and file["y"][()] == 2.0


def test_a_folder_is_no_file(tmp_path: Path) -> None:
    with pytest.raises(IsADirectoryError):
        NewFile(tmp_path)


@pytest.mark.parametrize("seed", range(0, 6, 2))
def test_ctrl_c_ends_writing_without_harm(tmp_path: Path, seed: int) -> None:
    """The signal may come while HDF5 is at the file: it is raised once the library has returned."""
    delay, path = 0.002 * (1 + 3 * seed), tmp_path / "file"

    def write() -> None:
        with NewFile(path) as file:
            rows = file.create_dataset("rows", (0, 500), "f8", maxshape=(None, 500), chunks=(1, 500))
            signal.setitimer(signal.ITIMER_REAL, delay, 0.001)
            for k in range(100_000):
                rows.resize(k + 1, axis=0)
                rows[k] = k
                if k % 3 == 0:
                    file.flush()

    handler = signal.signal(signal.SIGINT, signal.default_int_handler)
    alarm = signal.signal(signal.SIGALRM, lambda *_: once())

    def once() -> None:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.raise_signal(signal.SIGINT)

    try:
        with pytest.raises(KeyboardInterrupt):
            write()
        assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, alarm)
        signal.signal(signal.SIGINT, handler)
    with h5py.File(path) as file:
        rows = file["rows"][:-1]  # the last may have no numbers yet
        assert (rows == np.arange(len(rows))[:, None]).all()


def test_ctrl_c_within_the_library_waits(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    handler = signal.signal(signal.SIGINT, signal.default_int_handler)
    note = Sink._note
    try:
        with pytest.raises(KeyboardInterrupt), NewFile(tmp_path / "file") as file:
            with monkeypatch.context() as patch:
                patch.setattr(Sink, "_note", lambda sink, size: (signal.raise_signal(signal.SIGINT), note(sink, size)))
                file["x"] = 1.0
                super(NewFile, file).flush()
            file["y"] = 2.0
            file.flush()
    finally:
        signal.signal(signal.SIGINT, handler)
    with h5py.File(tmp_path / "file") as file:
        assert file["x"][()] == 1.0 and file["y"][()] == 2.0


def test_ctrl_c_within_weakref_waits_too(tmp_path: Path) -> None:
    """Python drops what is raised there."""
    callback = {"__name__": "weakref", "signal": signal}
    exec("def call(): signal.raise_signal(signal.SIGINT)", callback)
    handler = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with NewFile(tmp_path / "file") as file:
            callback["call"]()
            with pytest.raises(KeyboardInterrupt):
                file.flush()
            file["x"] = 1.0
    finally:
        signal.signal(signal.SIGINT, handler)
    with h5py.File(tmp_path / "file") as file:
        assert file["x"][()] == 1.0


def test_after_an_error_the_bytes_are_those_that_were_marked(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(sink: Sink, size: int) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    path = tmp_path / "file"
    with Sink(path) as sink:
        sink.write(b"0123456789")
        sink.mark()
        for place, new in ((2, b"ab"), (3, b"cde"), (8, b"xyz")):
            sink.seek(place)
            sink.write(new)
        assert path.read_bytes() == b"01acde67xyz"
        monkeypatch.setattr(Sink, "_note", full)
        sink.write(b"more")
        with pytest.raises(OSError, match="No space left on device"):
            sink.check()
    assert path.read_bytes()[:10] == b"0123456789"


MOST = [0, 100, 512, 2048, 4096, *range(8192, 17_000, 800), 30_000, 10**6]


def on_small_disks(folder: Path, sender: Connection) -> None:
    """Write runs of steps where no file may have more than so many bytes; says what came of each."""
    import resource

    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    noise, corners = np.random.default_rng(1).normal(size=(STEPS, 3)), np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    for most in MOST:
        resource.setrlimit(resource.RLIMIT_FSIZE, (most, resource.getrlimit(resource.RLIMIT_FSIZE)[1]))
        (folder / str(most)).mkdir()
        steps = 0
        try:
            with vtkhdf.plate_file(folder / str(most), "run", corners, [[0, 1, 2]]) as plate:
                for k in range(STEPS):
                    plate.append(float(k), deflection=noise[k])
                    plate.flush()
                    steps = k + 1
        except OSError as error:
            sender.send((steps, error.strerror, error.filename))
        else:
            sender.send((steps, "", ""))


@pytest.mark.skipif(sys.platform == "win32", reason="there are no limits of file sizes")
def test_a_full_disk_is_an_error_and_leaves_what_was_flushed(tmp_path: Path) -> None:
    receiver, sender = multiprocessing.Pipe(duplex=False)
    child = multiprocessing.get_context("spawn").Process(target=on_small_disks, args=(tmp_path, sender))
    child.start()
    child.join()
    assert child.exitcode == 0
    for most in MOST:
        steps, said, name = receiver.recv()
        partial = tmp_path / str(most) / "run.partial.plate.vtkhdf"
        if most == 10**6:
            assert steps == STEPS and not said
            continue
        assert said == "File too large" and name == str(partial)
        assert not (tmp_path / str(most) / "run.plate.vtkhdf").exists()
        if steps:
            with h5py.File(partial) as file:
                assert steps <= file["VTKHDF/Steps"].attrs["NSteps"] <= steps + 1
                assert np.isfinite(file["VTKHDF/PointData/deflection"][: 3 * steps]).all()
