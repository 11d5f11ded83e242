"""Lanes: several numbers that kernels work on at once, as one vector of the processor.

A `spliced` function of numbers takes lanes too, of numba's type `lanes`; in plain Python they are arrays (LANES,). A
product that is added may be rounded once rather than twice, as processors with fused multiply-add do.
"""

from __future__ import annotations

import operator
from collections.abc import Callable
from typing import Any, Final

import numpy as np
from llvmlite import ir
from numba.core import types
from numba.core.typing.templates import AbstractTemplate, ConcreteTemplate, infer_global, signature
from numba.extending import lower_builtin, models, register_model

from particle.types import FloatArray

LANES: Final = 4
VECTOR = ir.VectorType(ir.DoubleType(), LANES)


class _Lanes(types.Type):  # type: ignore[misc]
    def __init__(self) -> None:
        super().__init__(name=f"lanes of {LANES}")


lanes = _Lanes()


@register_model(_Lanes)
class _Model(models.PrimitiveModel):  # type: ignore[misc]
    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, VECTOR)


def load(array: FloatArray, first: int) -> Any:
    """The lanes of an array (n,) from `first` on."""
    return array[first : first + LANES].copy()


def load_some(array: FloatArray, first: int, count: int) -> Any:
    """As `load`, with 0 in place of all but the first `count` of them."""
    return np.where(np.arange(LANES) < count, load(array, first), 0.0)


def lanes_of(a: float, b: float, c: float, d: float) -> Any:
    """Lanes of these numbers."""
    return np.array([a, b, c, d])


def total(x: Any) -> float:
    """The sum of lanes."""
    return float((x[0] + x[2]) + (x[1] + x[3]))


def store(array: FloatArray, first: int, value: Any) -> None:
    """Lanes into an array (n,) from `first` on."""
    array[first : first + LANES] = value


def nought(x: Any) -> Any:
    """0 of the kind of x, a number or lanes."""
    return 0.0 * x


def log(x: Any) -> Any:
    """The natural logarithm of a number or of lanes."""
    return np.log(x)


def at_least(x: Any, least: float) -> Any:
    """A number or lanes, not below a number."""
    return np.maximum(x, least)


def where_zero(x: Any, value: Any) -> Any:
    """A value where x is 0, else 0; numbers or lanes."""
    return np.where(x == 0.0, value, 0.0)


def _vector(context: Any, builder: Any, kind: Any, value: Any, wanted: Any) -> Any:
    """A number or lanes as one or the other."""
    if kind == lanes:
        return value
    number = context.cast(builder, value, kind, types.float64)
    if wanted != lanes:
        return number
    none, first = ir.Constant(VECTOR, ir.Undefined), ir.Constant(ir.IntType(32), 0)
    return builder.shuffle_vector(builder.insert_element(none, number, first), none, ir.Constant(_ORDER, [0] * LANES))


def _define(
    function: Callable[..., Any], cases: list[tuple[Any, ...]], build: Callable[..., Any], result: Any = None
) -> None:
    """Compile a function for `cases` of its arguments' types: build(builder, *values) is its code.

    result: the type of what it returns; by default arguments are made alike, and it is theirs.
    """
    signatures = [signature(result or (lanes if lanes in case else types.float64), *case) for case in cases]
    infer_global(function)(type("_Typed", (ConcreteTemplate,), {"cases": signatures}))

    def lower(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        if result is None:
            kinds = zip(sig.args, args, strict=True)
            args = [_vector(context, builder, kind, value, sig.return_type) for kind, value in kinds]
        return build(builder, *args)

    for case in cases:
        lower_builtin(function, *case)(lower)


def _operation(name: str) -> Callable[..., Any]:
    return lambda builder, a, b: getattr(builder, name)(a, b, flags=("contract",))


def _log(builder: Any, x: Any) -> Any:
    name = f"llvm.log.v{LANES}f64" if x.type == VECTOR else "llvm.log.f64"
    found = builder.module.globals.get(name) or ir.Function(builder.module, ir.FunctionType(x.type, [x.type]), name)
    return builder.call(found, [x])


def _at_least(builder: Any, x: Any, least: Any) -> Any:
    return builder.select(builder.fcmp_ordered(">", x, least), x, least)


def _where_zero(builder: Any, x: Any, value: Any) -> Any:
    return builder.select(builder.fcmp_ordered("==", x, _zero(x)), value, _zero(x))


def _lanes_of(builder: Any, *numbers: Any) -> Any:
    found = ir.Constant(VECTOR, ir.Undefined)
    for k, number in enumerate(numbers):
        found = builder.insert_element(found, number, ir.Constant(ir.IntType(32), k))
    return found


def _total(builder: Any, x: Any) -> Any:
    for order in ([2, 3, 2, 3], [1, 1, 1, 1]):
        x = builder.fadd(x, builder.shuffle_vector(x, x, ir.Constant(_ORDER, order)))
    return builder.extract_element(x, ir.Constant(ir.IntType(32), 0))


def _zero(x: Any) -> Any:
    return ir.Constant(x.type, [0.0] * LANES if x.type == VECTOR else 0.0)


_ORDER = ir.VectorType(ir.IntType(32), LANES)
_KINDS: tuple[Any, ...] = (lanes, types.float64, types.int64)
_PAIRS = [(a, b) for a in _KINDS for b in _KINDS if lanes in (a, b)]
_NAMES = {"fadd": (operator.add, operator.iadd), "fsub": (operator.sub,), "fmul": (operator.mul,)}
_NAMES["fdiv"] = (operator.truediv,)
for _name, _operators in _NAMES.items():
    for _operator in _operators:
        _define(_operator, _PAIRS, _operation(_name))
_define(operator.neg, [(lanes,)], lambda builder, x: builder.fneg(x))
_define(nought, [(lanes,), (types.float64,)], lambda builder, x: _zero(x))
_define(log, [(lanes,), (types.float64,)], _log)
_define(at_least, [(lanes, types.float64), (types.float64, types.float64)], _at_least)
_define(where_zero, [(lanes, lanes), (types.float64, types.float64)], _where_zero)
_define(lanes_of, [(types.float64,) * LANES], _lanes_of, lanes)
_define(total, [(lanes,)], _total, types.float64)


def _place(context: Any, builder: Any, kind: Any, array: Any, first: Any) -> Any:
    """The pointer to the lanes of an array from `first` on."""
    data = context.make_array(kind)(context, builder, array).data
    return builder.bitcast(builder.gep(data, [first]), ir.PointerType(VECTOR))


@infer_global(load)
class _Load(AbstractTemplate):  # type: ignore[misc]
    def generic(self, args: Any, kws: Any) -> Any:
        return signature(lanes, args[0], types.intp) if args[0].layout == "C" else None


@lower_builtin(load, types.Array, types.intp)  # type: ignore[untyped-decorator]
def _load(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    return builder.load(_place(context, builder, sig.args[0], *args), align=8)


@infer_global(load_some)
class _LoadSome(AbstractTemplate):  # type: ignore[misc]
    def generic(self, args: Any, kws: Any) -> Any:
        return signature(lanes, args[0], types.intp, types.intp) if args[0].layout == "C" else None


@lower_builtin(load_some, types.Array, types.intp, types.intp)  # type: ignore[untyped-decorator]
def _load_some(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    found = builder.load(_place(context, builder, sig.args[0], *args[:2]), align=8)
    counts, none = ir.VectorType(args[2].type, LANES), ir.Constant(ir.IntType(32), 0)
    one = builder.insert_element(ir.Constant(counts, ir.Undefined), args[2], none)
    count = builder.shuffle_vector(one, ir.Constant(counts, ir.Undefined), ir.Constant(_ORDER, [0] * LANES))
    within = builder.icmp_signed("<", ir.Constant(counts, list(range(LANES))), count)
    return builder.select(within, found, _zero(found))


@infer_global(store)
class _Store(AbstractTemplate):  # type: ignore[misc]
    def generic(self, args: Any, kws: Any) -> Any:
        return signature(types.none, args[0], types.intp, lanes) if args[0].layout == "C" else None


@lower_builtin(store, types.Array, types.intp, lanes)  # type: ignore[untyped-decorator]
def _store(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    builder.store(args[2], _place(context, builder, sig.args[0], *args[:2]), align=8)
    return context.get_dummy_value()
