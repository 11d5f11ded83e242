"""Files that are written as a whole or not at all, and read as a whole or not at all."""

from __future__ import annotations

import errno
import os
import re
import shutil
import stat
import tempfile
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path

MAX_TEXT = 2**24  # bytes of a case, study or aim
MAX_NUMBERS = 2**26  # bytes of a table of numbers
SPARE, TRIED = 2**21, 2**26  # bytes beyond what is needed, and at most that are reserved to see whether they are there
_open: set[Path] = set()
_CONTROL = re.compile(r"[\0-\x1f\x7f-\x9f\u2028-\u202e\u2066-\u2069\ud800-\udfff]")


def contents(path: str | os.PathLike[str], most: int) -> bytes:
    """What a file holds.

    Raises OSError when it cannot be read, has more than `most` bytes, or is a pipe or device, which need not end.
    """
    name = os.fspath(path)
    if "\0" in os.fsdecode(name):
        raise OSError(errno.EINVAL, "its name has a null character in it", name)
    # Without waiting for who might write to a pipe.
    descriptor = os.open(name, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
    with open(descriptor, "rb") as file:
        status = os.fstat(descriptor)
        if stat.S_ISDIR(status.st_mode):
            raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), name)
        if not stat.S_ISREG(status.st_mode):
            raise OSError(errno.EINVAL, "it is a pipe or a device, not a file", name)
        data = file.read(most + 1) if status.st_size <= most else b""
        if len(data) > most or status.st_size > most:
            raise OSError(errno.EFBIG, f"it has more than {most // 2**20} MiB, the most that is read", name)
    return data


def control_in(text: str) -> str:
    """The first character of a text that would command a terminal or turn its direction; "": there is none."""
    found = _CONTROL.search(text)
    return found[0] if found else ""


def printable(text: str) -> str:
    """A text, with lines, for a terminal or as JSON: names of files, and texts in them, may hold what commands it."""
    return _CONTROL.sub(lambda found: found[0] if found[0] == "\n" else f"\\u{ord(found[0]):04x}", text)


def why(error: OSError) -> str:
    """Why something cannot be done with a file, to follow a colon."""
    reason = error.strerror or str(error)
    return reason[:1].lower() + reason[1:]


def check_folder(folder: Path) -> None:
    """Raises ValueError unless the folder can be made and written to: better before the work than after it."""
    made = next(parent for parent in (folder, *folder.absolute().parents) if parent.exists())
    if not made.is_dir():
        raise ValueError(f"Input output must be a folder; got {folder}, but {made} is a file")
    try:
        os.rmdir(tempfile.mkdtemp(prefix=".active-surface-", dir=made))  # os.access says yes to root, even in /proc
    except OSError:
        raise ValueError(
            f"Input output must be a folder that can be written to; got {folder}, but {made} does not allow it"
        ) from None


def check_free(files: Sequence[Path], overwrite: bool) -> None:
    """Raises ValueError where files of one folder cannot be made, or are there and are not to be replaced."""
    folder = files[0].parent
    check_folder(folder)
    for file in files:
        if file.is_dir():
            raise ValueError(f"Input output must be free for {file.name}; got {folder}, where that is a folder")
    if not overwrite and (there := [file.name for file in files if file.exists()]):
        names, what = " and ".join(there), "them" if len(there) > 1 else "it"
        raise ValueError(
            f"Input output must be free of other results; got {folder}, which has {names}: --overwrite replaces {what}"
        )


def check_room(folder: Path, needed: int, kept: str = "") -> None:
    """Raise OSError unless a folder has room for so many bytes of results, and SPARE ones.

    A run shall not begin that cannot end, and HDF5 must not meet a full disk, on which it crashes.

    kept: what to say of what is there already.
    """
    needed += SPARE
    text = f"{folder}: the results take {needed / 1e6:.1f} MB"
    if (free := shutil.disk_usage(folder).free) < needed:
        raise OSError(f"{text}, and {free / 1e6:.1f} MB are free{kept}")
    if hasattr(os, "posix_fallocate"):
        try:
            with tempfile.TemporaryFile(dir=folder) as file:  # which meets quotas and limits of files as well
                os.posix_fallocate(file.fileno(), 0, min(needed, TRIED))
        except OSError as error:
            if error.errno in (errno.ENOSPC, errno.EDQUOT, errno.EFBIG):  # others are of disks that reserve nothing
                raise OSError(f"{text}: {why(error)}{kept}") from error


@contextmanager
def whole_file(
    path: Path,
    partial: Path | None = None,
    keep: bool = False,
    synced: bool = False,
    replace: Callable[[Path, Path], object] = os.replace,
) -> Iterator[Path]:
    """A path to write to; its file or folder replaces that at `path` when the `with` block ends well.

    If it does not, the partial file is removed.

    partial: the path to write to, by default beside `path` and of this process alone.
    keep: whether to leave the partial file when the block fails.  synced: whether to return once all is safe on disk.
    replace: puts the partial file or folder in place.
    """
    partial = partial or path.with_name(f"{path.stem}.{os.getpid()}.partial{path.suffix}")
    if not keep:
        _open.add(partial)
    try:
        yield partial
        if synced:
            _sync(partial)
        replace(partial, path)
        if synced and os.name != "nt":  # which syncs no folders
            _sync(path.parent)
    finally:
        if not keep:
            try:
                _remove(partial)
            finally:
                _open.discard(partial)


def remove_partial_files() -> None:
    """Remove what `whole_file` has open: before the process ends without leaving its `with` blocks."""
    for partial in list(_open):
        with suppress(OSError):
            _remove(partial)


def _remove(partial: Path) -> None:
    if partial.is_dir():
        shutil.rmtree(partial)
    else:
        partial.unlink(missing_ok=True)


def _sync(path: Path) -> None:
    """Return once what a file or folder holds is on disk."""
    descriptor = os.open(path, os.O_RDWR if os.name == "nt" else os.O_RDONLY)  # Windows syncs what it may write
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
