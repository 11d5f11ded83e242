"""The one place where kernels are compiled: cached on disk, IEEE arithmetic, other threads running on.

Only kernels that Python calls are compiled by themselves. What else they call is part of what they compile: numba makes
machine code of a kernel with all that it calls, and a way in from Python costs as much as most small functions do.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import numba
from numba.core import config
from numba.core.registry import CPUDispatcher

from particle.kernel_cache import KernelCache, place_of

Kernel = TypeVar("Kernel", bound=Callable[..., Any])
OPTIONS = {"error_model": "numpy", "nogil": True, "no_cfunc_wrapper": True}


def jit(kernel: Kernel) -> Kernel:
    """Compile a kernel that Python calls, at its first call (nothing when NUMBA_DISABLE_JIT=1)."""
    return _compiled(kernel)


def jit_no_arrays(kernel: Kernel) -> Kernel:
    """As `jit`, for kernels that make no arrays: without counting references to those that they get.

    They call only each other, such device functions, and functions of numbers. Some of numpy's functions, such as an
    array's `min`, make arrays inside; these compile here only if a kernel that makes arrays has been compiled before in
    the same process.
    """
    return _compiled(kernel, _nrt=False)


def device(function: Kernel) -> Kernel:
    """Compile a function that only kernels call, with these; Python that calls it runs it as Python."""
    return _device(function)


def device_no_arrays(function: Kernel) -> Kernel:
    """As `device`, for functions that make no arrays, as in `jit_no_arrays`."""
    return _device(function, _nrt=False)


def spliced(function: Kernel) -> Kernel:
    """As `device_no_arrays`, compiled into each caller, which drops what it does not use."""
    return _device(function, _nrt=False, forceinline=True)


def inlined(function: Kernel) -> Kernel:
    """Compile a function into the one kernel or function that calls it."""
    return _compiled(function, inline="always")


def _compiled(kernel: Kernel, **options: Any) -> Kernel:
    dispatcher = numba.njit(**OPTIONS, **options)(kernel)
    if not config.DISABLE_JIT and place_of(kernel).folder:
        dispatcher._cache = KernelCache(dispatcher)
    return dispatcher  # type: ignore[no-any-return]


def _device(function: Kernel, **options: Any) -> Kernel:
    dispatcher = numba.njit(**OPTIONS, no_cpython_wrapper=True, **options)(function)
    if not config.DISABLE_JIT:
        dispatcher.__class__ = _Device
    return dispatcher  # type: ignore[no-any-return]


class _Device(CPUDispatcher):  # type: ignore[misc]
    """A compiled function without a way in from Python."""

    def __call__(self, *arguments: Any) -> Any:
        return self.py_func(*arguments)


# For other packages: at the door of this one, `jit` is the module.
kernel, kernel_no_arrays, kernel_inlined = jit, jit_no_arrays, inlined
kernel_device, kernel_device_no_arrays = device, device_no_arrays
