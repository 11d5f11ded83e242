"""The one place where kernels are compiled: cached on disk, IEEE arithmetic, other threads running on.

Only kernels that Python calls are compiled by themselves. What else they call is part of what they compile: LLVM
optimises a kernel with all that it calls, and a way in from Python costs as much as most small functions do. numba
would optimise each function with what it calls, and make machine code of it; device functions leave it to the kernel.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any, TypeVar

import numba
from numba.core import config, serialize
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase, DefaultPassBuilder
from numba.core.compiler_machinery import register_pass
from numba.core.registry import CPUDispatcher
from numba.core.typed_passes import NativeLowering

from particle.kernel_cache import KernelCache, place_of

Kernel = TypeVar("Kernel", bound=Callable[..., Any])
# Kernels ask for the types of what they return. A Python function would raise KeyboardInterrupt in their midst, if
# Ctrl-C had arrived while they ran, and the process would crash. The cache answers without one.
serialize._numba_unpickle = cache(serialize._numba_unpickle)
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
    dispatcher = numba.njit(**OPTIONS, no_cpython_wrapper=True, pipeline_class=_DeviceCompiler, **options)(function)
    if not config.DISABLE_JIT:
        dispatcher.__class__ = _Device
    return dispatcher  # type: ignore[no-any-return]


class _Device(CPUDispatcher):  # type: ignore[misc]
    """A compiled function without a way in from Python."""

    def __call__(self, *arguments: Any) -> Any:
        return self.py_func(*arguments)

    def add_overload(self, compiled: Any) -> None:
        self.overloads[tuple(compiled.signature.args)] = compiled


class _DeviceLibrary(JITCodeLibrary):  # type: ignore[misc]
    """The code of a function and what it calls, not optimised: a kernel optimises all that it calls, once."""

    def _optimize_final_module(self) -> None:
        pass

    def _finalize_final_module(self) -> None:
        self._finalized = True


@register_pass(mutates_CFG=True, analysis_only=False)
class _DeviceLowering(NativeLowering):  # type: ignore[misc]
    """Make LLVM's code of a function, and no machine code."""

    _name = "device_lowering"

    def run_pass(self, state: Any) -> bool:
        state.library = _DeviceLibrary(state.targetctx.codegen(), state.func_id.func_qualname)
        state.library.enable_object_caching()
        state.flags.no_compile = True
        super().run_pass(state)
        key = object()
        state.targetctx.insert_user_function(key, state.cr.fndesc, [state.library])
        state.cr = state.cr._replace(cfunc=key)
        return True


class _DeviceCompiler(CompilerBase):  # type: ignore[misc]
    """numba's own, with this lowering."""

    def define_pipelines(self) -> list[Any]:
        pipeline = DefaultPassBuilder.define_nopython_pipeline(self.state)
        pipeline.passes = [
            (_DeviceLowering if step is NativeLowering else step, name) for step, name in pipeline.passes
        ]
        pipeline.finalize()
        return [pipeline]


# For other packages: at the door of this one, `jit` is the module.
kernel, kernel_no_arrays, kernel_inlined = jit, jit_no_arrays, inlined
kernel_device, kernel_device_no_arrays = device, device_no_arrays
