"""Knobs: which fields of a case the page has sliders for, and how far these go."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from typing import Any, Final, Literal

from common import unit_for
from coupling.case import Case, Field, PlateCase, find_field, lattice_of, quoted

Scale = Literal["linear", "log", "choice"]

ALL: Final = "*"
"""In place of a number: all actuators at once."""
DRIVEN: Final = ("stroke", "force", "frequency", "phase", "delay", "cycles", "dwell", "stiffness")
OF_PART: Final = (
    "position.0", "position.1", "heading", "sides.0", "sides.1", "radius", "thickness", "mass", "size", "centre_height",
    "squeeze", "velocity.0", "velocity.1",
)  # fmt: skip
OF_FRICTION: Final = (
    "limit", "coefficient", "static_coefficient", "adhesion", "plasticity_index", "adhesion_energy", "roughness",
    "contact_area", "hardness", "static_ratio",
)  # fmt: skip
OF_RUN: Final = ("duration", "gravity")
OF_PLATE: Final = ("thickness", "youngs_modulus", "poisson_ratio", "density", "tension", "pressure", "damping")
CHOICES: Final = {
    "plate.theory": ("linear", "von-karman"),
    "plate.inertia": ("false", "true"),
    "plate.top_face": ("false", "true"),
    "plate.supports": ("clamped", "simply-supported", "free"),
}
NAMES: Final = {
    "position.0": "x", "position.1": "y", "sides.0": "side x", "sides.1": "side y", "velocity.0": "velocity x",
    "velocity.1": "velocity y",
}  # fmt: skip
GRAMS: Final = 1e3  # in a kg
TIMES: Final = 8.0  # what sliders over powers of ten take a value by, up and down
OF_NOTHING: Final = {"m": 1e-5, "N": 1e-6, "s": 1e-3, "m/s": 0.1, "Pa": 100.0, "N/m": 10.0, "kg": 1e-9, "1": 1.0}
"""Where a slider ends whose value is 0."""


@dataclass(frozen=True)
class Knob:
    """A field of the case on the page; low and high are where its slider ends, in its unit."""

    path: str
    label: str
    help: str
    unit: str
    text: str  # the value, as a case file has it
    value: float | None  # in the unit; None: a choice, or not the same for all
    scale: Scale
    low: float = 0.0
    high: float = 1.0
    choices: tuple[str, ...] = ()
    whole: bool = False


def knobs_of(case: Case, selected: str) -> list[dict[str, Any]]:
    """The knobs of a case by groups; selected: the number of an actuator, or ALL."""
    groups: list[tuple[str, list[Knob]]] = []
    if isinstance(case.plate, PlateCase):
        title = "All actuators" if selected == ALL else f"Actuator {selected}"
        one = case.actuators[0 if selected == ALL else int(selected)]
        keys = [key for key in DRIVEN if _used(one, key)]
        places = [] if selected == ALL else ["position.0", "position.1"]
        groups.append((title, list(_found(case, f"actuators.{selected}", [*keys, *places]))))
    else:
        groups.append(("Platform", list(_of_platform(case))))
    part = case.part
    idle = ["heading"] if part.face is None else ["contact_area"]  # a point does not turn; the area of a face counts
    idle += ["contact_area"] if part.local_contact and part.size is not None else []
    for table, of in (("part", OF_PART), ("friction", OF_FRICTION)):
        groups.append((table.capitalize(), list(_found(case, table, [key for key in of if key not in idle]))))
    groups.append(("Run", list(_found(case, "run", OF_RUN))))
    if isinstance(case.plate, PlateCase):
        groups.append(("Plate", [*_chosen(case), *_found(case, "plate", OF_PLATE)]))
    return [{"title": title, "knobs": [asdict(knob) for knob in knobs]} for title, knobs in groups if knobs]


def allowed(case: Case, path: str) -> bool:
    """Whether the page may change a field."""
    if path in CHOICES:
        return True
    table, *keys = path.split(".")
    if table == "actuators":
        return len(keys) >= 2 and ".".join(keys[1:]) in (*DRIVEN, "position.0", "position.1")
    if table == "plate" and keys[:1] == ["motion"]:
        return len(keys) == 3 and keys[2] in DRIVEN
    of = {"part": OF_PART, "friction": OF_FRICTION, "run": OF_RUN, "plate": OF_PLATE}
    return ".".join(keys) in of.get(table, ())


def changes_of(case: Case, path: str, text: str) -> dict[str, Any]:
    """What `Case.vary` is to change where a text was typed into a field; ValueError: a number was wanted."""
    if path in CHOICES:
        return {path: text == "true" if text in ("true", "false") else text}
    field = find_field(case, lattice_of(case)[0], path)
    value: Any = text
    if field.unit == "1" or field.kind == "whole":
        try:
            value = int(text) if field.kind == "whole" else float(text)
        except ValueError:
            must = "a whole number such as 5" if field.kind == "whole" else "a number such as 0.3"
            raise ValueError(f"must be {must}, without a unit; got {quoted(text)}") from None
    changes = {path: value}
    if path == "friction.plasticity_index" and getattr(case.friction, "preset", None):
        changes = {"friction.preset": None, **changes}  # which sets the index
    return changes


def _used(table: Any, key: str) -> bool:
    """Whether a drive has a field, or would take it as it is."""
    if getattr(table, key, None) is None:
        return False
    if key in ("phase", "dwell"):
        cyclic = table.frequency is not None and table.table is None and table.segments is None
        return cyclic and table.cycle in (("up-down", "sine", "cosine") if key == "phase" else ("up-down",))
    return True


def _of_platform(case: Case) -> Iterator[Knob]:
    motion = getattr(case.plate, "motion", None)
    for axis in ("x", "y", "z"):
        drive = getattr(motion, axis, None)
        if drive is not None:
            keys = [key for key in DRIVEN if _used(drive, key)]
            for knob in _found(case, f"plate.motion.{axis}", keys):
                yield Knob(**asdict(knob) | {"label": f"{axis}: {knob.label}"})


def _found(case: Case, table: str, keys: Any) -> Iterator[Knob]:
    """Yield the knobs for those keys that the table has a value at."""
    for key in keys:
        path = f"{table}.{key}"
        try:
            field = find_field(case, None, path)
        except ValueError:
            continue
        if field.base is None and (ALL not in path or key not in DRIVEN):
            continue
        if isinstance(field.base, str):
            continue
        yield _knob(case, field, key)


def _knob(case: Case, field: Field, key: str) -> Knob:
    value = None if field.base is None else float(field.base)
    low, high, scale = _range(case, key, field.unit, value)
    name, per_si = _unit(field.unit, abs(value) if value else max(abs(low), abs(high)))
    return Knob(
        path=field.path,
        label=NAMES.get(key, key.replace("_", " ")),
        help=_help(case, field),
        unit=name,
        text="" if value is None else f"{value * per_si:.12g} {name}".strip(),
        value=None if value is None else value * per_si,
        scale=scale,
        low=low * per_si,
        high=high * per_si,
        whole=field.kind == "whole",
    )


def _unit(si: str, size: float) -> tuple[str, float]:
    """The unit of a slider, as case files write it, and how many of it make up the SI unit."""
    if si == "rad":
        return "deg", 180 / math.pi
    if si in ("1", ""):
        return "", 1.0
    if si == "kg":
        unit = unit_for(GRAMS * size, "g")
        return unit.name.replace("\N{MICRO SIGN}", "u"), GRAMS * unit.per_si
    if not si.isalpha():  # a prefix would count as often as the unit does
        return si, 1.0
    unit = unit_for(size, si)
    return unit.name.replace("\N{MICRO SIGN}", "u"), unit.per_si


def _range(case: Case, key: str, unit: str, value: float | None) -> tuple[float, float, Scale]:
    """The ends of a slider [SI], and how it goes from one to the other."""
    size = abs(value or 0.0)
    if key.startswith("position"):
        plate = case.plate
        if isinstance(plate, PlateCase):
            low, high = plate.coarse_mesh.outline.box[:, int(key[-1])].tolist()
            return low, high, "linear"
        return -max(2 * size, 1e-4), max(2 * size, 1e-4), "linear"
    if key.startswith("velocity"):
        return -max(2 * size, 0.1), max(2 * size, 0.1), "linear"
    if key in ("phase", "heading"):
        most = max(math.pi, size)
        return -most, most, "linear"
    if key == "poisson_ratio":
        return 0.0, 0.49, "linear"
    if key == "damping":
        return 0.0, max(2 * size, 0.1), "linear"
    if key in ("delay", "dwell"):
        slowest = min((a.frequency for a in case.actuators if a.frequency), default=1e3)
        return 0.0, max(2 / slowest, 2 * size), "linear"
    if key in ("stroke", "force", "tension", "pressure"):
        most = 2 * size or OF_NOTHING.get(unit, 1.0)
        return (-most, 0.0, "linear") if (value or 0.0) < 0 else (0.0, most, "linear")
    if size == 0:
        return 0.0, OF_NOTHING.get(unit, 1.0), "linear"
    return size / TIMES, size * TIMES, "log"


def _chosen(case: Case) -> Iterator[Knob]:
    """Yield the knobs of the plate that are choices."""
    for path, choices in CHOICES.items():
        value = getattr(case.plate, path.split(".")[1])
        text = json.dumps(value) if isinstance(value, bool) else value
        if isinstance(text, str):
            field = type(case.plate).model_fields[path.split(".")[1]]
            label = path.split(".")[1].replace("_", " ")
            yield Knob(path, label, field.description or "", "", text, None, "choice", choices=choices)


def _help(case: Case, field: Field) -> str:
    """What the documentation says of a field."""
    table: Any = case
    description = ""
    for key in field.locations[0]:
        if isinstance(key, int):
            table = table[key]
        else:
            description = type(table).model_fields[key].description or ""
            table = getattr(table, key)
    return description
