"""Files that are written as a whole or not at all."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

_open: set[Path] = set()


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
