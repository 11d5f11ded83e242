"""Lock: one process at a time works in a folder."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from filelock import FileLock, Timeout

NAME = "lock"


@contextmanager
def alone_in(folder: Path) -> Iterator[None]:
    """Lock a folder, making it if need be; at the end it is removed if it is empty, as are the parents made for it.

    Raises RuntimeError when another process holds the lock. The lock of a killed process is free.
    """
    made = [folder, *(parent for parent in folder.parents if not parent.exists())]
    lock = _locked(folder / NAME)
    try:
        yield
    finally:
        with suppress(OSError):  # Windows removes the file on release, and not before
            Path(lock.lock_file).unlink()
        lock.release()
        with suppress(OSError):
            for parent in made:
                parent.rmdir()


def _locked(file: Path) -> FileLock:
    lock = FileLock(file, blocking=False)
    while not lock.is_locked:
        with suppress(FileNotFoundError):  # another process removed the folder just then
            file.parent.mkdir(parents=True, exist_ok=True)
            try:
                lock.acquire()
            except Timeout:
                raise RuntimeError(f"another sweep of this name is running in {file.parent.parent}") from None
    return lock
