"""Groups of arrays and numbers, such as a surface, that kernels get by one address.

numba hands a tuple from function to function item by item: the arrays of a surface are some 400 words. Of a class that
is `grouped`, a kernel's way in lays the items out once, in memory that nothing changes, and hands on where that is.
Arrays are borrowed: a kernel must not return one of a group.
"""

from __future__ import annotations

from hashlib import blake2b
from typing import Any, TypeVar

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.datamodel import models, register_default
from numba.core.imputils import lower_getattr_generic
from numba.core.pythonapi import NativeValue, unbox
from numba.core.typing.templates import AttributeTemplate, infer_getattr
from numba.core.typing.typeof import typeof_impl

Class = TypeVar("Class", bound=type)
INVARIANT = "invariant.load"


def grouped(cls: Class) -> Class:
    """Have kernels get instances of a named tuple by their address."""

    def type_of(value: Any, context: Any) -> Group:
        return Group(cls.__name__, cls._fields, tuple(typeof_impl(item, context) for item in value))  # type: ignore[attr-defined]

    typeof_impl.register(cls, type_of)
    return cls


class Group(types.Type):  # type: ignore[misc]
    """The type of a group: the names of its items, and their types."""

    def __init__(self, name: str, names: tuple[str, ...], items: tuple[types.Type, ...]) -> None:
        self.items = dict(zip(names, items, strict=True))
        digest = blake2b("".join(f"{one} {item.name}, " for one, item in self.items.items()).encode(), digest_size=8)
        super().__init__(name=f"{name}_{digest.hexdigest()}")  # short, as all who take it are named after it

    def laid_out(self, context: Any) -> ir.LiteralStructType:
        """What its memory holds."""
        return ir.LiteralStructType([_stored(context, item) for item in self.items.values()])

    def place(self, name: str) -> int:
        return list(self.items).index(name)


def _stored(context: Any, item: types.Type) -> ir.Type:
    return item.laid_out(context) if isinstance(item, Group) else context.data_model_manager[item].get_data_type()


register_default(Group)(models.OpaqueModel)


@infer_getattr
class _Items(AttributeTemplate):  # type: ignore[misc]
    key = Group

    def generic_resolve(self, group: Group, name: str) -> types.Type | None:
        return group.items.get(name)


@lower_getattr_generic(Group)  # type: ignore[untyped-decorator]
def _item(context: Any, builder: ir.IRBuilder, group: Group, address: ir.Value, name: str) -> ir.Value:
    """An item of a group."""
    place = _places(builder, builder.bitcast(address, group.laid_out(context).as_pointer()), group.place(name))
    item = group.items[name]
    if isinstance(item, Group):
        return builder.bitcast(place, address.type)
    return context.data_model_manager[item].from_data(builder, _loaded(builder, place))


def _places(builder: ir.IRBuilder, address: ir.Value, *within: int) -> ir.Value:
    return builder.gep(address, [ir.IntType(32)(k) for k in (0, *within)], inbounds=True)


def _loaded(builder: ir.IRBuilder, place: ir.Value) -> ir.Value:
    """What is at a place and never changes, number by number: LLVM drops that mark from loads of whole structures."""
    of = place.type.pointee
    if isinstance(of, ir.LiteralStructType | ir.ArrayType):
        value = ir.Constant(of, ir.Undefined)
        for k in range(len(of)):
            value = builder.insert_value(value, _loaded(builder, _places(builder, place, k)), k)
        return value
    loaded = builder.load(place)
    loaded.set_metadata(INVARIANT, builder.module.add_metadata([]))
    return loaded


@unbox(Group)  # type: ignore[untyped-decorator]
def _from_python(group: Group, value: ir.Value, c: Any) -> NativeValue:
    """Lay out a named tuple on the stack of the way in."""
    memory = cgutils.alloca_once(c.builder, group.laid_out(c.context))
    failed = cgutils.alloca_once_value(c.builder, cgutils.false_bit)
    _lay_out(group, value, memory, failed, c)
    # LLVM must not see what the address is of: it would take what is loaded later for what there was before this.
    same = ir.FunctionType(cgutils.voidptr_t, [cgutils.voidptr_t])
    address = c.builder.asm(
        same, "", "=r,0,~{memory}", [c.builder.bitcast(memory, cgutils.voidptr_t)], side_effect=True
    )
    return NativeValue(address, is_error=c.builder.load(failed))


def _lay_out(of: types.Type, value: ir.Value, memory: ir.Value, failed: ir.Value, c: Any) -> None:
    """Write an object of a type into memory."""
    if isinstance(of, Group | types.BaseTuple):
        for k, item in enumerate(of.items.values() if isinstance(of, Group) else of.types):
            _lay_out(item, c.pyapi.tuple_getitem(value, k), _places(c.builder, memory, k), failed, c)
    elif isinstance(of, types.Array):
        adapt = ir.FunctionType(ir.IntType(32), [c.pyapi.pyobj, c.pyapi.voidptr])
        borrow = c.pyapi._get_function(adapt, name="numba_adapt_ndarray")
        code = c.builder.call(borrow, (value, c.builder.bitcast(memory, c.pyapi.voidptr)))
        with c.builder.if_then(cgutils.is_not_null(c.builder, code), likely=False):
            c.pyapi.err_set_string("PyExc_TypeError", "an item of a group is no array any more")
            c.builder.store(cgutils.true_bit, failed)
    else:
        number = c.unbox(of, value)
        with c.builder.if_then(number.is_error, likely=False):
            c.builder.store(cgutils.true_bit, failed)
        c.builder.store(c.context.data_model_manager[of].as_data(c.builder, number.value), memory)
