"""The one place where kernels are compiled: cached on disk, IEEE arithmetic, other threads running on."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any, TypeVar

import numba

Kernel = TypeVar("Kernel", bound=Callable[..., Any])


def bare(kernel: Kernel) -> Kernel:
    """As `jit`, for kernels that make no arrays: without counting references to those that they are given."""
    return numba.njit(cache=True, error_model="numpy", nogil=True, _nrt=False)(kernel)  # type: ignore[no-any-return]


def jit(kernel: Kernel) -> Kernel:
    """Compile a kernel at its first call (nothing when NUMBA_DISABLE_JIT=1)."""
    return numba.njit(cache=True, error_model="numpy", nogil=True)(kernel)  # type: ignore[no-any-return]


def _drop_stale_kernels(folder: Path) -> None:
    """Empty the folder's cache of kernels when any source has changed.

    numba looks at a kernel's own file only and would go on with old code of the kernels that it calls.
    """
    sources = b"".join(path.read_bytes() for path in sorted(folder.rglob("*.py")))
    digest, cache = hashlib.sha256(sources).hexdigest(), folder / "__pycache__"
    note = cache / "kernels.sha256"
    with suppress(OSError):  # a folder that cannot be written to holds no cache either
        if note.exists() and note.read_text() == digest:
            return
        cache.mkdir(exist_ok=True)
        for file in cache.glob("*.nb[ic]"):
            file.unlink(missing_ok=True)
        note.write_text(digest)


_drop_stale_kernels(Path(__file__).parent)
