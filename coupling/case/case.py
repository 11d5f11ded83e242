"""The case: what one run simulates, read from a TOML file or built in Python.

Every quantity is stored as a float in SI units, and every position as (x, y) from the centre of the plate. Built in
Python, a float is taken as SI and text with a unit is converted; in a file every quantity must state its unit.
Python gets an `InputError` for wrong values, and from `read_case` a `CaseError`; both are a ValueError.
"""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

from pydantic import ValidationError, model_validator

from common import draw, notebook_html
from coupling.case.actuators import LatticeCase
from coupling.case.checks import build
from coupling.case.fields import lattice_of, locations_of, put_value
from coupling.case.friction import KogutEtsionCase
from coupling.case.part import UNUSED
from coupling.case.plates import PlatformCase
from coupling.case.table import Faults, InputError, mistakes_of
from coupling.case.tables import CaseTables
from coupling.case.toml_file import parse
from coupling.case.values import UNITS_REQUIRED, quoted

if TYPE_CHECKING:
    from common import Axes, Figure


class Case(CaseTables):
    """What one run simulates; `name` is the stem of the file it was read from, and `source` the text of that file.

    A lattice becomes actuators, after those that are given one by one; then there is no `lattice` any more. Measured
    friction gets the points in its file, and has no `file` any more. Each of many parts has a case of its own.
    """

    name: str = "case"
    source: str | None = None

    @model_validator(mode="before")
    @classmethod
    def _built(cls, data: Any) -> Any:
        if not isinstance(data, dict):
            return data
        own = {key: data[key] for key in ("name", "source") if key in data}
        tables = {key: value for key, value in data.items() if key not in own}
        if tables.get("parts"):
            raise Faults(
                [(("parts",), "must be left out, as each part has a case of its own: see read_parts, run_parts")]
            )
        return build(CaseTables.model_validate(_completed(tables), context={})) | own

    def vary(self, changes: Mapping[str, Any], name: str | None = None) -> Self:
        """The same case with other values in some fields.

        Parameters
        ----------
        changes : mapping of str to value
            The place of each field, as in studies: ``"actuators.0.frequency"``, ``"part.position.1"``,
            ``"actuators.*.stroke"``. Indices count from 0, * stands for all. Its value is a text with a unit, or a
            number in SI units; for a place that is a list or table, all of that. Later ones go over earlier ones.
        name : str, optional
            Of the new case, by default the old one.

        Returns
        -------
        case : Case
            The new case; it has no `source`.

        Raises
        ------
        InputError
            Names every place that is no field and every wrong value, or that `changes` is no such mapping. After
            `lattice` is varied once its actuators are those of the case, and there is no `lattice` any more.
        """
        wrong = [path for path in changes if not isinstance(path, str)] if isinstance(changes, Mapping) else [changes]
        if wrong:
            must = 'must give values by the paths of their fields, such as {"part.mass": "3 ng"}'
            raise InputError("vary", [("changes", f"{must}; got {quoted(wrong[0])}")])
        if "part.mass" in changes and "part.density" not in changes and self.part.density is not None:
            changes = {"part.density": None, **changes}  # in place of which there is a mass
        tables: dict[str, Any] = {key: getattr(self, key) for key in CaseTables.model_fields}
        lattice, alone = None, len(self.actuators)
        if any(path.split(".")[0] == "lattice" for path in changes):
            lattice, alone = lattice_of(self)
        if lattice:
            tables["lattice"] = LatticeCase.model_validate(lattice, context=UNITS_REQUIRED)
        tables["actuators"] = actuators = list[Any](self.actuators[:alone])
        problems: list[tuple[str, str]] = []
        for path, value in changes.items():
            try:
                for location in locations_of(self, lattice, path):
                    if location[0] == "actuators" and len(location) > 1:
                        if (k := int(location[1])) >= alone:
                            must = f"must not vary actuators from {alone} on"
                            raise ValueError(f"{must}: the changed lattice makes them anew")
                        if tables["actuators"] is actuators:
                            actuators[k] = put_value(actuators[k], location[2:], value)  # in place: they may be many
                            continue
                    tables = put_value(tables, location, value)
            except ValueError as error:
                problems.append((path, str(error)))
        try:
            made = type(self)(**tables, name=self.name if name is None else name)
        except InputError as error:
            problems += error.problems
        if problems:
            raise InputError(type(self).__name__, problems)
        return made

    @property
    def footprint(self) -> float | None:
        """The side [m] of the part's footprint, or the root of the contact area; None: neither is given.

        Of a face the larger of its extents along its own x and y.
        """
        if (face := self.part.face) is not None:
            return 2 * face.radius or float((face.corners.max(axis=0) - face.corners.min(axis=0)).max())
        if self.part.size is None and isinstance(self.friction, KogutEtsionCase):
            return math.sqrt(self.friction.contact_area)
        return self.part.size

    def __repr__(self) -> str:
        count, part, friction = len(self.actuators), self.part, self.friction.model
        over = f"{count} actuator{'s' * (count != 1)} under a plate" if count else "a platform"
        moved = f"a part of {part.mass:.4g} kg at ({part.position[0]:.4g}, {part.position[1]:.4g}) m"
        return f"Case {self.name!r}: {over}, {moved}, {friction} friction, {self.run.duration:.4g} s"

    __str__ = __repr__

    def plot(self, axes: Axes | None = None) -> Figure:
        """Draw the plate from above with its actuators, and where the part starts, into axes in m or new ones."""
        return draw(self, axes)

    _repr_html_ = notebook_html


def read_case(path: str | os.PathLike[str], may_move: bool = False) -> Case:
    """Read the case file at `path`; CaseError with every mistake in it, or with the reason why it cannot be read.

    may_move: accept that supports and actuators leave the plate free to move as a whole. Such a case does not run, but
    has frequency responses.
    """
    cases = read_parts(path, may_move)
    if len(cases) > 1:
        only = "only `active-surface run` and `check` take more"
        raise parse(path).error(
            [(("parts",), f"must be one part here, for which there is [part]; got {len(cases)}; {only}")]
        )
    return cases[0]


def read_parts(path: str | os.PathLike[str], may_move: bool = False) -> list[Case]:
    """Read the case file at `path`, a case for each of its parts; raises as `read_case`.

    These cases are alike except for their parts. Each of several has the name of its part, or its number from 0.
    """
    file = parse(path)
    context = UNITS_REQUIRED | {"folder": Path(path).absolute().parent}
    try:
        built = build(CaseTables.model_validate(_completed(file.tables), context=context), may_move)
    except (ValidationError, Faults) as error:
        raise file.error(mistakes_of(error, CaseTables, file.tables)) from None
    first, parts = Case.model_construct(**built | {"parts": ()}, name=Path(path).stem, source=file.text), built["parts"]
    if len(parts) < 2:
        return [first]
    return [
        first.model_copy(update={"part": part.alone, "name": part.named(number)}) for number, part in enumerate(parts)
    ]


def _completed(tables: Mapping[str, Any]) -> dict[str, Any]:
    """The tables of a case, which need no actuators beside a lattice or a platform, and no [part] beside [[parts]]."""
    plate = tables.get("plate")
    platform = isinstance(plate, PlatformCase) or (isinstance(plate, dict) and plate.get("shape") == "platform")
    needless = {"actuators": ()} if platform or tables.get("lattice") is not None else {}
    return needless | ({"part": UNUSED} if tables.get("parts") else {}) | dict(tables)
