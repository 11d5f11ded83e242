"""Kernels that make no arrays compile in any order: they call nothing that makes arrays inside."""

import ast
import importlib
import inspect
import textwrap
from pathlib import Path

import pytest
from numba.core.dispatcher import Dispatcher

pytestmark = pytest.mark.compiled

ROOT = Path(__file__).parents[2]
OF_NUMBERS = {"np.floor", "np.searchsorted"}
"""Functions of numpy that such kernels may call: of a number, or that give one without making arrays."""


def kernels():
    """All kernels by name, as numba's dispatchers or, where these are switched off, none."""
    for path in sorted(path for folder in ("particle", "coupling") for path in (ROOT / folder).rglob("*.py")):
        text = path.read_text()
        if "jit" not in text and "import kernel" not in text:
            continue
        name = ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")
        for value in vars(importlib.import_module(name)).values():
            if isinstance(value, Dispatcher) and value.py_func.__module__ == name:
                yield f"{name}.{value.py_func.__name__}", value


def makes_none(kernel):
    return kernel.targetoptions.get("_nrt") is False


def test_kernels_without_arrays_call_nothing_that_makes_them():
    every = [(name, kernel) for name, kernel in kernels() if makes_none(kernel)]
    assert len(every) > 100
    wrong = []
    for name, kernel in every:
        function = ast.parse(textwrap.dedent(inspect.getsource(kernel.py_func)))
        for call in (node for node in ast.walk(function) if isinstance(node, ast.Call)):
            text = ast.unparse(call.func)
            if isinstance(call.func, ast.Name):
                called = kernel.py_func.__globals__.get(text)
                wrong += [f"{name} calls {text}"] * (isinstance(called, Dispatcher) and not makes_none(called))
            elif not text.startswith("math.") and text not in OF_NUMBERS:
                wrong.append(f"{name} calls {text}")
    assert not wrong
