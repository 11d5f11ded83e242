"""The one place where kernels are compiled: cached on disk, IEEE arithmetic, other threads running on."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import numba

Kernel = TypeVar("Kernel", bound=Callable[..., Any])


def jit(kernel: Kernel) -> Kernel:
    """Compile a kernel at its first call (nothing when NUMBA_DISABLE_JIT=1)."""
    return numba.njit(cache=True, error_model="numpy", nogil=True)(kernel)  # type: ignore[no-any-return]
