"""The parameters of an identification: free fields of cases, with bounds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, Final

import numpy as np

from active_surface.arrays import FloatArray
from active_surface.parameter import Parameter
from coupling.case import Case, Field, find_field, quoted

FACTOR: Final = 10.0  # either way, of usual bounds
FREE: Final = ("part", "friction")  # tables whose fields one moving surface serves
PLACES: Final = ("part.position.", "part.velocity.")  # of which a factor says nothing

Bounds = Mapping[str, Sequence[Any]]


def parameters_of(
    cases: Sequence[Case], free: Sequence[str], own: Sequence[str], bounds: Bounds
) -> list[list[Parameter]]:
    """For each case its parameters: shared ones, with the same bounds for all, then own ones.

    Raises ValueError with every mistake in their paths and bounds, and the cases that have it if not all do.
    """
    kinds = dict.fromkeys(own, "own") | dict.fromkeys(free, "free")
    wrong = _miswritten(free, own, bounds)
    mistakes: dict[tuple[str, str], list[str]] = {}
    columns = {
        path: [one for case in cases if (one := _parameter(case, path, kind, bounds, mistakes))]
        for path, kind in kinds.items()
    }
    for (name, mistake), names in mistakes.items():
        wrong.append((name, mistake if len(names) == len(cases) else f"{mistake} (in {', '.join(names)})"))
    if wrong:
        raise ValueError("\n".join(f"Input {name} of identify {mistake}" for name, mistake in wrong))
    for path in free:
        low, high = min(one.low for one in columns[path]), max(one.high for one in columns[path])
        columns[path] = [replace(one, low=low, high=high, logarithmic=low > 0) for one in columns[path]]
    return [list(row) for row in zip(*(columns[path] for path in (*free, *own)), strict=True)]


def _miswritten(free: Sequence[str], own: Sequence[str], bounds: Bounds) -> list[tuple[str, str]]:
    """What is wrong with the paths, whatever the cases have."""
    wrong = [("bounds", f"must be of free fields; got {path}") for path in bounds if path not in (*free, *own)]
    for name, paths in (("free", free), ("own", own)):
        twice = sorted(path for path in {*paths} if paths.count(path) > 1)
        wrong += [(name, f"must name each field once; got {path} twice") for path in twice]
    both = [path for path in dict.fromkeys(own) if path in free]
    wrong += [("own", f"must be other fields than the shared ones of free; got {path} in both") for path in both]
    if not (free or own):
        wrong.append(("free", "must name at least one field, such as friction.coefficient"))
    return wrong


def _parameter(
    case: Case, path: str, kind: str, bounds: Bounds, mistakes: dict[tuple[str, str], list[str]]
) -> Parameter | None:
    """A parameter of a case; None where it has none, with the case's name added to those with that mistake."""
    try:
        field = _field(case, path)
    except ValueError as error:
        mistakes.setdefault((kind, str(error)), []).append(case.name)
        return None
    try:
        return _bounded(field, bounds.get(path))
    except ValueError as error:
        mistakes.setdefault(("bounds", f"of {path} {error}"), []).append(case.name)
        return None


def _field(case: Case, path: str) -> Field:
    field = find_field(case, None, path)
    if field.locations[0][0] not in FREE:
        raise ValueError(f"must be fields of [part] or [friction], which leave the surface as it is; got {path}")
    if field.kind != "number":
        raise ValueError(f"must be numbers; got {path}, a {field.kind}")
    return field


def _bounded(field: Field, given: Sequence[Any] | None) -> Parameter:
    example = {"N": '"1 nN", "1 uN"', "m": '"0 um", "100 um"', "kg": '"1e-10 kg", "1e-8 kg"'}.get(
        field.unit, "0.1, 0.9"
    )
    if given is None:
        if field.path.startswith(PLACES) or not isinstance(field.base, (int, float)) or field.base <= 0:
            has = "nothing" if field.base is None else f"{field.base:g}"
            raise ValueError(f"must be given, such as {example}: no factor of what the case has, {has}, leads to any")
        low, high = (_farthest(field, field.base, factor) for factor in (1 / FACTOR, FACTOR))
    else:
        if isinstance(given, str) or len(given) != 2:
            raise ValueError(f"must be two values, such as {example}; got {quoted(given)}")
        low, high = (_read(field, value) for value in given)
    if not low < high:
        raise ValueError(f"must increase; got {low:g} and {high:g} in SI units")
    return Parameter(field, low, high, logarithmic=low > 0)


def _read(field: Field, value: Any) -> float:
    if isinstance(value, str) and field.unit == "1":
        try:
            value = float(value)
        except ValueError:
            raise ValueError(f"must be two plain numbers; got {quoted(value)}") from None
    read = field.read(value, in_si=not isinstance(value, str))
    assert isinstance(read, (int, float))
    return float(read)


def _farthest(field: Field, base: float, factor: float) -> float:
    """The value nearest to a factor times the base that the field may have."""
    return next(value for share in np.linspace(1, 0, 21) if _allowed(field, value := float(base * factor**share)))


def _allowed(field: Field, value: float) -> bool:
    try:
        field.read(value, in_si=True)
    except ValueError:
        return False
    return True


def case_with(case: Case, parameters: Sequence[Parameter], shares: FloatArray) -> Case:
    """The case with parameters at shares (n,) of their bounds; ValueError where its tables contradict."""
    changes = {one.field.path: float(one.value(share)) for one, share in zip(parameters, shares, strict=True)}
    return case.vary(changes)
