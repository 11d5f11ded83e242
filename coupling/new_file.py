"""HDF5 files that are written. The library crashes where the disk fills meanwhile, unless the error is kept from it."""

from __future__ import annotations

import io
import os
import sys
from pathlib import Path
from typing import Any

import h5py  # type: ignore[import-untyped]


class Sink(io.FileIO):
    """The file at a path, emptied, in the form that the library writes to; it keeps the first error of writing.

    From then on it writes nothing, and the library goes on as if it had. What was flushed before can still be read.

    Raises BlockingIOError where another process writes the file, OSError where it cannot be opened.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        super().__init__(os.open(path, os.O_RDWR | os.O_CREAT | getattr(os, "O_BINARY", 0), 0o666), "r+")
        self._name = os.fspath(path)
        self._error: OSError | None = None
        try:
            _lock(self.fileno())
            super().truncate(0)
        except BaseException:
            self.close()
            raise

    def check(self) -> None:
        """Raise the error that was kept, with the file's name."""
        if self._error is not None:
            raise OSError(self._error.errno, self._error.strerror, self._name) from self._error

    def readinto(self, room: Any) -> int:
        """Fill some room, with zeros beyond the end of the file."""
        view = memoryview(room).cast("B")
        count = super().readinto(view) or 0
        view[count:] = bytes(len(view) - count)
        return len(view)

    def write(self, data: Any) -> int:
        """Write bytes, unless an error is kept."""
        left = memoryview(data).cast("B")
        size = len(left)
        try:
            while left and self._error is None:
                left = left[super().write(left) or 0 :]
        except OSError as error:
            self._error = error
        return size

    def truncate(self, size: int | None = None) -> int:
        """Give the file another size, unless an error is kept."""
        try:
            if self._error is None:
                return super().truncate(size)
        except OSError as error:
            self._error = error
        return size or 0


class NewFile(h5py.File):  # type: ignore[misc]
    """An HDF5 file to write at a path; `flush` and `close` raise OSError when the disk had no room."""

    def __init__(self, path: str | Path) -> None:
        self._sink = Sink(path)
        try:
            super().__init__(self._sink, "w")
        except BaseException:
            self._sink.close()
            raise

    def flush(self) -> None:
        """Hand all that was written to the system, where it outlives this process."""
        super().flush()
        self._sink.check()

    def close(self) -> None:
        """Write what is left and close the file."""
        super().close()
        self._sink.close()
        self._sink.check()


if sys.platform == "win32":
    import msvcrt

    def _lock(descriptor: int) -> None:
        os.lseek(descriptor, 2**40, os.SEEK_SET)  # a byte that nobody reads, as locks keep readers out there
        try:
            msvcrt.locking(descriptor, msvcrt.LK_NBLCK, 1)
        except OSError as error:
            raise BlockingIOError(error.errno, error.strerror) from error

else:
    import fcntl

    def _lock(descriptor: int) -> None:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)  # as HDF5 itself does, whose readers heed it
