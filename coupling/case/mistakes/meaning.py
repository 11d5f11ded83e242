"""Meaning: which key somebody meant by one that a table does not have, and what to write for its value."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from decimal import Decimal, InvalidOperation
from typing import Any, Final, Literal, NamedTuple, get_args, get_origin

from pydantic.fields import FieldInfo

from coupling.case.values import Quantity, number_and_unit, parts_of, quantity_of, quoted
from coupling.suggestion import near
from coupling.synonyms import SIDES, Conversion, Synonym, plain, synonyms

Fields = Mapping[str, FieldInfo]
WhyWrong = Callable[[str, Any], str]
"""What is wrong with a value of a key; "" for nothing."""

_PAIRS: Final = (("x", "y"), ("pos_x", "pos_y"), ("x0", "y0"), ("vx", "vy"))
_ENDS: Final = (
    *(("min", "max"), ("from", "to"), ("start", "stop"), ("start", "end"), ("low", "high"), ("lower", "upper")),
    *(("first", "last"), ("begin", "end")),
)
_WHOLE: Final = 1e-6  # from a whole number
_DIGITS: Final = ".10g"


class Meaning(NamedTuple):
    """What is meant by a key."""

    keys: tuple[str, ...]
    text: str  # what to do about it


def meaning_of(key: str, table: Mapping[str, Any], fields: Fields, why_wrong: WhyWrong) -> Meaning | None:
    """What is meant by a key of a table that its fields do not have; None: it is like none of them.

    why_wrong: says what is wrong with a value of one of the fields.
    """
    meaning = _meaning(key, table, fields, why_wrong)
    if meaning is None:
        return None
    there = next((name for name in meaning.keys if name in table), None)
    if there:
        return meaning._replace(text=f"{there} is given already; leave out one of the two")
    before = [other for other in list(table)[: list(table).index(key)] if other not in fields]
    for other in before:
        same = _meaning(other, table, fields, why_wrong)
        if same and same.keys == meaning.keys and same.text != meaning.text:
            return meaning._replace(text=f"it stands for {meaning.keys[0]} as {other} does; leave out one of the two")
    return meaning


def _meaning(key: str, table: Mapping[str, Any], fields: Fields, why_wrong: WhyWrong) -> Meaning | None:
    options = sorted(synonyms(key, fields), key=lambda option: any(name in table for name in option.keys))
    quantities = [quantity_of(fields[o.keys[0]].annotation, fields[o.keys[0]].metadata) for o in options]
    units = {quantity.unit if quantity else None for quantity in quantities}
    if isinstance(table[key], float) and len(units) > 1:  # SI, in Python: a number does not tell which it is
        return Meaning(options[0].keys, f"did you mean {' or '.join(option.keys[0] for option in options)}?")
    for option in options:
        values = _converted(option, key, table, fields)
        if values and not any(why_wrong(*item) for item in values.items()):
            return Meaning(option.keys, f"write {_lines(values)}")
    if options:
        return _named(options, key, table, fields, why_wrong)
    meant = near(key, fields)
    if meant is None:
        return None
    value = _chosen(table[key], fields[meant])
    if value != table[key] and not why_wrong(meant, value):
        return Meaning((meant,), f"write {_lines({meant: value})}")
    return Meaning((meant,), _with_reason(f"did you mean {meant}?", why_wrong(meant, table[key])))


def _named(options: list[Synonym], key: str, table: Mapping[str, Any], fields: Fields, why_wrong: WhyWrong) -> Meaning:
    """The meaning where no value follows: that of the key which suits the value best."""
    suits = [option for option in options if not why_wrong(option.keys[0], table[key])]
    option = (suits or options)[0]
    if option.hint[:1].islower():
        return Meaning(option.keys, option.hint)
    question = f"did you mean {' and '.join(option.keys)}?"
    if option.hint:
        return Meaning(option.keys, f"{question} {option.hint}")
    values = _converted(option, key, table, fields) or {option.keys[0]: table[key]}
    return Meaning(option.keys, _with_reason(question, why_wrong(*next(iter(values.items())))))


def _with_reason(question: str, reason: str) -> str:
    return f"{question} It {reason}" if reason else question


def _lines(values: Mapping[str, Any]) -> str:
    return " and ".join(f"{key} = {_toml(value)}" for key, value in values.items())


def _toml(value: Any) -> str:
    if isinstance(value, dict):
        return "{ " + _lines(value).replace(" and ", ", ") + " }"
    return quoted(value)


def _converted(option: Synonym, key: str, table: Mapping[str, Any], fields: Fields) -> dict[str, Any] | None:
    """The keys that a synonym stands for with their values; None where these do not follow."""
    value = table[key]
    if option.conversion == "square":
        return dict.fromkeys(option.keys, value)
    (meant, *_) = option.keys
    try:
        converted = _value(option.conversion, key, value, table)
    except (ValueError, ArithmeticError, KeyError, TypeError, InvalidOperation):
        return None
    return None if converted is None else {meant: _chosen(converted, fields[meant])}


def _value(conversion: Conversion, key: str, value: Any, table: Mapping[str, Any]) -> Any:
    """The value of a synonym; None where it does not follow, raises one of several errors where it makes no sense."""
    cycle = near(str(table.get("cycle")), ("up-down", "up", "sine", "cosine")) or "up-down"
    cycle = table["cycle"] if table.get("cycle") in ("up-down", "up", "sine", "cosine") else cycle
    match conversion:
        case "same":
            return value
        case "half":
            return _times(value, Decimal("0.5"))
        case "amplitude":
            return value if cycle == "sine" else None
        case "peak":
            return _times(value, Decimal("0.5")) if cycle == "sine" else value
        case "inverse":
            return _quantity(1 / _si(value, "s"), "Hz", value)
        case "angular":
            return _quantity(_si(value, "rad/s") / (2 * math.pi), "Hz", value)
        case "degrees":
            return f"{float(value):{_DIGITS}} deg"
        case "quality":
            return float(f"{0.5 / float(value):{_DIGITS}}")
        case "stress":
            return _quantity(_si(value, "Pa") * _si(table["thickness"], "m"), "N/m", value)
        case "side":
            sides = table.get("sides") or SIDES[plain(str(table["shape"]))]
            return _times(value, Decimal(f"{0.5 / math.sin(math.pi / sides):{_DIGITS}}"))
        case "step":
            return value if table.get("scheme") in ("fixed", "paper") else None
        case "duration":
            cycles = _si(value, "s") * _si(table["frequency"], "Hz")
            return round(cycles) if abs(cycles - round(cycles)) < _WHOLE else None
        case "repeats":
            return None if "table" in table or "segments" in table else value
        case "place" | "speed":
            return _both(key, table, _PAIRS)
        case "range":
            return _both(key, table, _ENDS)
        case _:
            return None


def _times(value: Any, factor: Decimal) -> Any:
    """A number, or a text of one and its unit, times a factor."""
    if isinstance(value, str):
        number, unit = number_and_unit(value)
        return f"{float(Decimal(number) * factor):{_DIGITS}} {unit}"
    return float(value) * float(factor)


def _si(value: Any, unit: str) -> float:
    """A value in an SI unit."""
    return Quantity(unit, "").parse(value) if isinstance(value, str) else float(value)


def _quantity(value: float, unit: str, like: Any) -> Any:
    """A value in an SI unit, as text where another is one."""
    return f"{value:{_DIGITS}} {unit}" if isinstance(like, str) else value


def _both(key: str, table: Mapping[str, Any], pairs: tuple[tuple[str, str], ...]) -> list[Any] | None:
    """The values of two keys, of which one is given, as one list."""
    own = {plain(str(other)): value for other, value in table.items()}
    found = [pair for pair in pairs if plain(key) in map(plain, pair) and all(plain(name) in own for name in pair)]
    return [own[plain(name)] for name in found[0]] if found else None


def _chosen(value: Any, field: FieldInfo) -> Any:
    """A value, or the choice that is meant by it where a field is a choice."""
    parts = parts_of(field.annotation)
    words = [word for part in parts if get_origin(part) is Literal for word in get_args(part) if isinstance(word, str)]
    if isinstance(value, dict):
        return {key: _chosen(item, field) for key, item in value.items()}
    if isinstance(value, str) and words and value not in words:
        return near(value, words) or value
    return value
