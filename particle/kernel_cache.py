"""Where compiled kernels are kept: a folder named by the hash of the package's sources, so that none can be stale.

numba compares a kernel's own file only, and would go on with old code of the kernels that it calls. Kernels of rooms
outside the package may call those of their room, of rooms that it imports them from, and of the package; they are kept
by the hash of all these.
"""

from __future__ import annotations

import glob
import hashlib
import os
import pickle
import shutil
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple
from uuid import uuid4

import numba
from numba.core import config, event
from numba.core.caching import Cache, CompileResultCacheImpl, _CacheLocator, _SourceFileBackedLocatorMixin
from numba.core.dispatcher import Dispatcher
from numba.core.runtime import rtsys
from numba.core.serialize import dumps
from numba.misc.appdirs import AppDirs

PACKAGE = Path(__file__).parent
PREFIX = "kernels-"
MAX_FOLDERS = 4  # of the last used sources; others may belong to another checkout, or to the state before an edit
MAX_WAIT = 300.0  # s, for another process to compile a kernel


def _sources(package: Path) -> list[Path]:
    """The sources of a package; none in an archive. A dangling link, as an editor's lock, is none."""
    return sorted(path for path in package.rglob("*.py") if path.is_file())


def source_digest(*packages: Path) -> str:
    """A hash of all sources of packages; empty where one has none."""
    digest = hashlib.sha256()
    for package in packages:
        sources = _sources(package)
        if not sources:
            return ""
        for path in sources:
            digest.update(path.relative_to(package).as_posix().encode() + b"\0")
            digest.update(hashlib.sha256(path.read_bytes()).digest())
    return digest.hexdigest()[:32]


def source_stamps(*packages: Path) -> frozenset[tuple[str, int, int]]:
    """What changes when any source is edited: its name, time and size."""
    stats = ((str(path), path.stat()) for package in packages for path in _sources(package))
    return frozenset((name, stat.st_mtime_ns, stat.st_size) for name, stat in stats)


def cache_folder(package: Path, digest: str, prefix: str = PREFIX) -> Path | None:
    """The folder for kernels of these sources; None where no place can be written to.

    It lies in NUMBA_CACHE_DIR if that is set, else beside the sources, else in the user's folder of caches.
    """
    user = Path(AppDirs(appname="active-surface", appauthor=False).user_cache_dir)
    places = [Path(config.CACHE_DIR) / "active-surface"] if config.CACHE_DIR else []
    for place in [*places, package / "__pycache__", user] if digest else []:
        folder = place / f"{prefix}{digest}"
        if _can_write(folder):
            _remove_unused(place, prefix)
            return folder
    return None


def _can_write(folder: Path) -> bool:
    """Whether files can be made in the folder, which is made and marked as used."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        tempfile.TemporaryFile(dir=folder).close()
        os.utime(folder)
    except OSError:
        return False
    return True


def _remove_unused(place: Path, prefix: str) -> None:
    """Keep the folders used last; a process that still uses another one compiles anew what it lacks."""
    with suppress(OSError):
        folders = sorted(place.glob(f"{prefix}*"), key=lambda folder: folder.stat().st_mtime, reverse=True)
        for folder in folders[MAX_FOLDERS:]:
            shutil.rmtree(folder, ignore_errors=True)


class Place(NamedTuple):
    """Where kernels that depend on the same sources are kept."""

    packages: tuple[Path, ...]  # the sources
    stamps: frozenset[tuple[str, int, int]]  # theirs when they were loaded
    folder: Path | None  # None: nowhere

    @property
    def is_current(self) -> bool:
        """Whether no source has been edited since."""
        return source_stamps(*self.packages) == self.stamps


@cache
def _place(packages: tuple[Path, ...], prefix: str) -> Place:
    return Place(packages, source_stamps(*packages), cache_folder(packages[0], source_digest(*packages), prefix))


def place_of(kernel: Callable[..., Any]) -> Place:
    """Where a kernel is kept: with those of the package, or of the room outside it that has its file."""
    rooms = _rooms(kernel)
    return _place((*rooms, PACKAGE), f"{rooms[0].name}-{PREFIX}" if rooms else PREFIX)


def _rooms(kernel: Callable[..., Any]) -> list[Path]:
    """The folders outside the package of the functions that a kernel may call, its own first."""
    files: dict[str, Path] = {}
    left = [kernel]
    while left:
        function = left.pop()
        file = function.__code__.co_filename
        if file not in files and PACKAGE not in Path(file).parents:
            files[file] = Path(file).parent
            left += [called.py_func for called in function.__globals__.values() if isinstance(called, Dispatcher)]
    return list(dict.fromkeys(files.values()))


class _Locator(_SourceFileBackedLocatorMixin, _CacheLocator):  # type: ignore[misc]
    """Files of one kernel in the folder."""

    def __init__(self, kernel: Callable[..., Any]) -> None:
        self._folder = str(place_of(kernel).folder)
        self._py_file = kernel.__code__.co_filename
        self._name = f"{kernel.__module__}-{kernel.__code__.co_firstlineno}"

    def get_cache_path(self) -> str:
        return self._folder

    def get_disambiguator(self) -> str:
        return self._name


class _CacheImpl(CompileResultCacheImpl):  # type: ignore[misc]
    """As numba's own, with our folder whatever its settings are."""

    def __init__(self, kernel: Callable[..., Any]) -> None:
        self._lineno = kernel.__code__.co_firstlineno
        self._locator = _Locator(kernel)
        self._filename_base = self.get_filename_base(kernel.__qualname__, getattr(sys, "abiflags", ""))


class _Forms:
    """The compiled forms of one kernel, a file each.

    numba keeps them in numbered files beside an index. A process that ends between writing the two leaves an index
    that names the wrong file, so here a file's name follows from its key, which the file holds, too. A file is whole or
    not there; one that cannot be read, as after a power cut, counts as not there.
    """

    def __init__(self, folder: str, base: str) -> None:
        self._folder, self._base = Path(folder), base

    def _path(self, key: Any) -> Path:
        digest = hashlib.sha256(f"{numba.__version__} {key!r}".encode()).hexdigest()
        return self._folder / f"{self._base}.{digest[:16]}.nbc"

    def load(self, key: Any) -> Any:
        """The form with a key; None where there is none."""
        try:
            its_key, form = pickle.loads(self._path(key).read_bytes())
        except Exception:  # whatever unpickling half a file raises
            return None
        return form if its_key == key else None

    def save(self, key: Any, form: Any) -> None:
        """Keep a form."""
        path = self._path(key)
        partial = path.with_suffix(f".{uuid4().hex[:8]}.tmp")
        try:
            partial.write_bytes(dumps((key, form)))
            os.replace(partial, path)
        except BaseException:
            partial.unlink(missing_ok=True)
            raise

    def flush(self) -> None:
        """Remove all forms."""
        for path in self._folder.glob(f"{glob.escape(self._base)}.*"):
            path.unlink(missing_ok=True)


class KernelCache(Cache):  # type: ignore[misc]
    """The cache of one kernel.

    Once a source has been edited under a running process, nothing is loaded or saved any more. Of several processes
    that need a kernel, one compiles it while the others wait.
    """

    _impl_class = _CacheImpl
    _compiling: KernelCache | None = None  # the kernel that this process is compiling, with all that it calls

    def __init__(self, dispatcher: Any) -> None:
        super().__init__(dispatcher.py_func)
        self._cache_file = _Forms(self.cache_path, self._impl.filename_base)
        self._dispatcher = dispatcher
        self._place = place_of(dispatcher.py_func)
        self._lock: Any = None

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        if not self._place.is_current:
            return None
        kernel = self._load(sig, target_context)
        if kernel is not None or not self._begin():
            return kernel
        kernel = self._load(sig, target_context)  # another process may have compiled it
        if kernel is not None:
            self._end()
        return kernel

    def _load(self, sig: Any, target_context: Any) -> Any:
        """As numba's `load_overload`, without `target_context.refresh()`, which imports what only compiling needs."""
        rtsys.initialize(target_context)
        with self._guard_against_spurious_io_errors():
            return self._load_overload(sig, target_context)

    def save_overload(self, sig: Any, data: Any) -> None:
        try:
            if self._place.is_current:
                super().save_overload(sig, data)
        finally:
            if KernelCache._compiling is self:
                self._end()

    def _begin(self) -> bool:
        """Wait until no other process compiles this kernel; False within another kernel, which is locked already."""
        from filelock import FileLock, Timeout  # here, because a run with cached kernels needs no lock

        other = KernelCache._compiling
        if other is not None and other._dispatcher._compiling_counter:
            return False
        if other is not None:  # its compilation was broken off
            other._end()
        # Another thread may let it go. What two kernels call may be compiled by two processes at once, and saved twice.
        lock = FileLock(Path(self.cache_path) / f"{self._impl.filename_base}.lock", thread_local=False)
        with suppress(Timeout, OSError, NotImplementedError):  # then both compile it
            self._impl.locator.ensure_cache_path()
            lock.acquire(timeout=MAX_WAIT)
        KernelCache._compiling, self._lock = self, lock
        return True

    def _end(self) -> None:
        KernelCache._compiling = None
        self._lock.release()


@contextmanager
def compilation_heard(tell: Callable[[], object]) -> Iterator[None]:
    """Calls `tell` when the first kernel is compiled, on whatever thread; never where all of them are on disk."""

    class Once(event.Listener):
        heard = False

        def on_start(self, started: object) -> None:
            if not self.heard:
                self.heard = True
                tell()

        def on_end(self, ended: object) -> None:
            pass

    with event.install_listener("numba:compile", Once()):
        yield
