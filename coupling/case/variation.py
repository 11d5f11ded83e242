"""Variation: the tables of a case in plain values, and the same with other values in some places."""

from __future__ import annotations

import tomllib
from typing import TYPE_CHECKING, Any, Final

from coupling.case.mistakes import Location
from coupling.case.table import Table

if TYPE_CHECKING:
    from coupling.case.case import Case

LEFT_OUT: Final = ("name", "source")  # of a case, what no file has
KINDS: Final = ("model", "shape")  # say which table it is, also where Python's class does


def plain_case(case: Case) -> dict[str, Any]:
    """The tables of a case as dicts of SI values."""
    return {key: table for key, table in plain_tables(case).items() if key not in LEFT_OUT}


def lattice_of(case: Case) -> tuple[dict[str, Any] | None, int]:
    """The [lattice] in the text of a case, and how many actuators are given beside it one by one."""
    written = tomllib.loads(case.source) if case.source else {}
    # Beside a lattice that is written none need be, and those of the case are the lattice's.
    return written.get("lattice"), len(written.get("actuators", () if "lattice" in written else case.actuators))


def plain_tables(value: Any) -> Any:
    """Tables as dicts of what was given in them, and all else as it is."""
    if isinstance(value, Table):
        fields = type(value).model_fields
        return {
            key: plain_tables(item)
            for key in fields
            if (item := getattr(value, key)) is not None
            and (
                key in value.model_fields_set or key in KINDS or fields[key].default is None or isinstance(item, tuple)
            )
        }
    if isinstance(value, tuple):
        return tuple(plain_tables(item) for item in value)
    return value


def put_value(value: Any, location: Location, new: Any) -> Any:
    """The same tables with another value at a location."""
    if not location:
        return new
    key, *rest = location
    if isinstance(value, (tuple, list)):
        index = int(key)
        return (*value[:index], put_value(value[index], tuple(rest), new), *value[index + 1 :])
    return {**value, key: put_value(value.get(key), tuple(rest), new)}


def value_at(value: Any, location: Location) -> Any:
    """What tables have at a location; None where there is nothing."""
    for key in location:
        if isinstance(value, (tuple, list)):
            value = value[int(key)]
        else:
            value = value.get(key) if isinstance(value, dict) else getattr(value, str(key), None)
    return value
