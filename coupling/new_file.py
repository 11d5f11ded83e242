"""HDF5 files that are written. The library crashes where the disk fills meanwhile, unless the error is kept from it."""

from __future__ import annotations

import errno
import io
import os
import signal
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from types import FrameType
from typing import Any

import h5py  # type: ignore[import-untyped]


class Sink(io.FileIO):
    """The file at a path, emptied, in the form that the library writes to; it keeps the first error of writing.

    From then on it writes nothing, and the library goes on as if it had. The bytes are those of the last `mark` again.
    Ctrl-C waits until the library has returned, and is raised by `check`.

    Raises BlockingIOError where another process writes the file, OSError where it cannot be opened.
    """

    _handler: Callable[[int, FrameType | None], Any] | None = None  # of Ctrl-C outside

    def __init__(self, path: str | os.PathLike[str]) -> None:
        super().__init__(os.open(path, os.O_RDWR | os.O_CREAT | getattr(os, "O_BINARY", 0), 0o666), "r+")
        self._name = os.fspath(path)
        self._error: OSError | None = None
        self._marked, self._before = 0, list[tuple[int, bytes]]()  # bytes then, and what they were where they changed
        self._interrupted = False
        try:
            _lock(self.fileno())
            super().truncate(0)
        except BaseException:
            super().close()
            raise
        self._guard()

    def mark(self) -> None:
        """What is in the file now is whole: it is to be there again after an error."""
        self._marked, self._before = os.fstat(self.fileno()).st_size, []

    def check(self) -> None:
        """Raise the error that was kept, with the file's name, or KeyboardInterrupt after Ctrl-C."""
        if self._interrupted:
            self._interrupted = False
            raise KeyboardInterrupt
        if self._error is not None:
            raise OSError(self._error.errno, self._error.strerror, self._name) from self._error

    def readinto(self, room: Any) -> int:
        """Fill some room, with zeros beyond the end of the file."""
        view = memoryview(room).cast("B")
        first = 0
        while first < len(view) and (count := super().readinto(view[first:])):
            first += count
        view[first:] = bytes(len(view) - first)
        return len(view)

    def write(self, data: Any) -> int:
        """Write bytes, unless an error is kept."""
        left = memoryview(data).cast("B")
        size = len(left)
        if self._error is None:
            try:
                self._note(size)
                while left:
                    left = left[super().write(left) or 0 :]
            except OSError as error:
                self._fail(error)
        return size

    def truncate(self, size: int | None = None) -> int:
        """Give the file another size, unless an error is kept."""
        try:
            if self._error is None:
                return super().truncate(size)
        except OSError as error:
            self._fail(error)
        return size or 0

    def close(self) -> None:
        """Let the file go."""
        if self._handler is not None and signal.getsignal(signal.SIGINT) == self._handed:
            signal.signal(signal.SIGINT, self._handler)
        self._handler = None
        super().close()

    def _note(self, size: int) -> None:
        """Keep the marked bytes that the next so many replace."""
        place = self.tell()
        if place < self._marked:
            old = bytearray(min(size, self._marked - place))
            self.readinto(old)
            self._before.append((place, bytes(old)))
            self.seek(place)

    def _fail(self, error: OSError) -> None:
        """Keep an error, and have the file as it was marked; that takes no room."""
        self._error = error
        for place, old in reversed(self._before):
            self.seek(place)
            super().write(old)

    def _guard(self) -> None:
        """Have Ctrl-C wait while the library is at the file: an error there would crash it, too."""
        handler = signal.getsignal(signal.SIGINT)
        if threading.current_thread() is threading.main_thread() and callable(handler):
            self._handler = handler
            signal.signal(signal.SIGINT, self._handed)

    def _handed(self, number: int, frame: FrameType | None) -> None:
        at = frame
        while at is not None and at.f_code not in WORK and at.f_globals.get("__name__") != "weakref":
            at = at.f_back  # what h5py hears from weakref cannot raise
        if at is not None:
            self._interrupted = True
        elif callable(self._handler):
            self._handler(number, frame)


WORK = {
    each.__code__ for each in (Sink.write, Sink.readinto, Sink.truncate, Sink._note, Sink._fail, Sink.mark, Sink.close)
}


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
        self._sink.mark()

    def close(self) -> None:
        """Write what is left and close the file."""
        try:
            super().close()
        finally:
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
        """Lock a file as HDF5 does, whose readers heed it, or not, where that is not wanted or there are no locks."""
        if os.environ.get("HDF5_USE_FILE_LOCKING", "").upper() in ("FALSE", "0"):
            return
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            if error.errno not in (errno.ENOSYS, errno.ENOTSUP, errno.ENOLCK):
                raise
