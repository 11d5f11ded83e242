"""The one place where kernels are compiled: cached on disk, IEEE arithmetic, other threads running on.

numba makes machine code of each kernel with all that it calls, so a chain of kernels is compiled as often as it is
deep. A kernel with a single caller is therefore compiled as part of it (`inlined`).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import numba
from numba.core import config

from particle.kernel_cache import KernelCache, place_of

Kernel = TypeVar("Kernel", bound=Callable[..., Any])


def jit(kernel: Kernel) -> Kernel:
    """Compile a kernel at its first call (nothing when NUMBA_DISABLE_JIT=1)."""
    return _compiled(kernel)


def jit_no_arrays(kernel: Kernel) -> Kernel:
    """As `jit`, for kernels that make no arrays: without counting references to those that they get.

    They call only each other, `inlined` ones that make no arrays either, and functions of numbers. Some of numpy's
    functions, such as an array's `min`, make arrays inside; these compile here only if a kernel that makes arrays has
    been compiled before in the same process.
    """
    return _compiled(kernel, _nrt=False)


def inlined(kernel: Kernel) -> Kernel:
    """Compile a kernel as part of the one kernel that calls it."""
    return _compiled(kernel, inline="always")


def _compiled(kernel: Kernel, **options: Any) -> Kernel:
    dispatcher = numba.njit(error_model="numpy", nogil=True, no_cfunc_wrapper=True, **options)(kernel)
    if not config.DISABLE_JIT and place_of(kernel).folder:
        dispatcher._cache = KernelCache(dispatcher)
    return dispatcher  # type: ignore[no-any-return]


# For other packages: at the door of this one, `jit` is the module.
kernel, kernel_no_arrays, kernel_inlined = jit, jit_no_arrays, inlined
