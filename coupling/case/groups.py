"""Groups: the rows and columns of an array, and a case in which only some actuators run, or all without an end."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import Any, Final

from coupling.case.actuators import ENDLESS, ActuatorCase
from coupling.case.case import Case

KINDS: Final = "all", "columns", "rows", "each"
SAME_LINE: Final = 1e-3  # of an array's longer side: actuators as near to each other along an axis are of one line


def groups_of(case: Case, kind: str) -> dict[str, tuple[int, ...]]:
    """The actuators' numbers by groups: all; each column from the left, from 0; each row from below; or each.

    Raises ValueError for another kind.
    """
    if kind not in KINDS:
        raise ValueError(f'Input groups must be "all", "columns", "rows" or "each"; got {kind!r}')
    count = len(case.actuators)
    if kind == "all":
        return {"all": tuple(range(count))}
    if kind == "each":
        return {f"actuator {k}": (k,) for k in range(count)}
    sides = list(zip(*(one.position for one in case.actuators), strict=True))
    near = SAME_LINE * max(max(side) - min(side) for side in sides)
    lines = _lines(sides[0 if kind == "columns" else 1], near)
    return {f"{kind[:-1]} {number}": line for number, line in enumerate(lines)}


def _lines(along: Sequence[float], near: float) -> list[tuple[int, ...]]:
    """The numbers of those with about the same coordinate, from the least coordinate on."""
    order, lines = sorted(range(len(along)), key=along.__getitem__), list[list[int]]()
    for k in order:
        if not lines or along[k] - along[lines[-1][-1]] > near:
            lines.append([])
        lines[-1].append(k)
    return [tuple(sorted(line)) for line in lines]


def running_case(case: Case, numbers: Collection[int]) -> Case:
    """The case in which only the actuators of these numbers run; the others stay at 0, or push with no force.

    Raises ValueError for a number that no actuator has.
    """
    if wrong := sorted(set(numbers) - set(range(len(case.actuators)))):
        raise ValueError(f"Input numbers of actuators must be from 0 to {len(case.actuators) - 1}; got {wrong[0]}")
    actuators = [one if k in numbers else at_rest(one) for k, one in enumerate(case.actuators)]
    return case.model_copy(update={"actuators": tuple(actuators)})


def at_rest(actuator: ActuatorCase) -> ActuatorCase:
    """The actuator with a drive that does not move."""
    update: dict[str, Any] = {"force": 0.0} if actuator.force is not None else {"stroke": 0.0}
    if actuator.frequency is None:  # a table or a schedule
        update |= {"frequency": 1.0, "table": None, "segments": None, "repeats": 1}
    return actuator.model_copy(update=update)


def endless_case(case: Case) -> Case:
    """The case whose drives go on without an end, and have their full strokes from the first cycle on.

    Raises ValueError where a drive does not come back.
    """
    for k, one in enumerate(case.actuators):
        if one.cycle == "up" and (one.stroke or one.force):
            raise ValueError(f'actuators[{k}].cycle must not be "up" here, as the drive must repeat')
    return case.model_copy(update={"actuators": tuple(map(_endless, case.actuators))})


def _endless(actuator: ActuatorCase) -> ActuatorCase:
    passes: Sequence[Any] = actuator.table or actuator.segments or ()
    return actuator.model_copy(update={"cycles": None, "ramp": 0.0} | ({"repeats": ENDLESS} if passes else {}))
