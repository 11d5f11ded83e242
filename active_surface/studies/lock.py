"""Lock: one process at a time works in a folder."""

from __future__ import annotations

import fcntl
import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

NAME = "lock"


@contextmanager
def alone_in(folder: Path) -> Iterator[None]:
    """Have a folder for oneself; afterwards it is removed if it is empty, with those around it that were made for it.

    Raises RuntimeError when another process has it. The lock of a process that was killed is free.
    """
    file = folder / NAME
    made = [folder, *(around for around in folder.parents if not around.exists())]
    descriptor = _held(file)
    try:
        yield
    finally:
        file.unlink(missing_ok=True)
        os.close(descriptor)
        with suppress(OSError):
            for one in made:
                one.rmdir()


def _held(file: Path) -> int:
    while True:
        with suppress(FileNotFoundError):
            file.parent.mkdir(parents=True, exist_ok=True)
            descriptor = os.open(file, os.O_RDWR | os.O_CREAT)
            try:
                fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                os.close(descriptor)
                raise RuntimeError(f"another sweep of this name is running in {file.parent.parent}") from None
            if os.fstat(descriptor).st_nlink:
                return descriptor
            os.close(descriptor)  # that of a process which removed it just then
