"""Kernels that make no arrays call nothing that makes arrays inside; each is compiled once, with what calls it."""

import ast
import importlib
import inspect
import re
import textwrap
from collections import Counter
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
        if not re.search(r"jit|import .*\bkernel", text):
            continue
        name = ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")
        for value in vars(importlib.import_module(name)).values():
            if isinstance(value, Dispatcher) and value.py_func.__module__ == name:
                yield f"{name}.{value.py_func.__name__}", value


def is_inlined(kernel):
    return kernel.targetoptions.get("inline") == "always"


def calls(function):
    """The calls in a function, by the text of what is called."""
    tree = ast.parse(textwrap.dedent(inspect.getsource(function)))
    return [ast.unparse(call.func) for call in ast.walk(tree) if isinstance(call, ast.Call)]


def test_kernels_without_arrays_call_nothing_that_makes_them():
    every = [(name, kernel) for name, kernel in kernels() if kernel.targetoptions.get("_nrt") is False]
    assert len(every) > 80
    wrong = []
    while every:
        name, kernel = every.pop()
        for text in calls(kernel.py_func):
            called = kernel.py_func.__globals__.get(text)
            if isinstance(called, Dispatcher) and is_inlined(called):
                every.append((f"{name} > {text}", called))
            elif isinstance(called, Dispatcher):
                wrong += [f"{name} calls {text}"] * (called.targetoptions.get("_nrt") is not False)
            elif "." in text and not text.startswith("math.") and text not in OF_NUMBERS:
                wrong.append(f"{name} calls {text}")
    assert not wrong


def test_an_inlined_kernel_is_called_once_and_by_a_kernel():
    """Its code would stand twice in what is compiled; Python would compile it by itself."""
    every, count = dict(kernels()), Counter()
    for kernel in every.values():
        for text in calls(kernel.py_func):
            called = kernel.py_func.__globals__.get(text)
            if isinstance(called, Dispatcher):
                count[called] += 1
    inlined = {name: count[kernel] for name, kernel in every.items() if is_inlined(kernel)}
    assert len(inlined) > 30
    assert {name: number for name, number in inlined.items() if number != 1} == {}


def test_python_calls_no_kernel_without_a_way_in():
    """It would run as Python, a hundred times slower."""
    wrong = []
    for path in sorted(path for folder in ("particle", "coupling") for path in (ROOT / folder).rglob("*.py")):
        if path.name == "__init__.py" or "kernel" not in path.read_text() and "particle" not in path.read_text():
            continue
        name = ".".join(path.relative_to(ROOT).with_suffix("").parts)
        for function in vars(importlib.import_module(name)).values():
            if not (inspect.isfunction(function) and function.__module__ == name):
                continue
            for text in calls(function):
                called = function.__globals__.get(text)
                if isinstance(called, Dispatcher) and called.targetoptions.get("no_cpython_wrapper"):
                    wrong.append(f"{name}.{function.__name__} calls {text}")
    assert wrong == []
