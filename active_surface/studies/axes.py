"""The axes of a study file, each with the field that it varies, and what is wrong with them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from active_surface.studies.axis import Axis, counted, spaced
from active_surface.studies.points_file import PointsFile, tables_of
from active_surface.studies.variants import is_deep
from coupling import near
from coupling.case import Case, Field, Location, Mistake, Value, find_field, lattice_of, quoted


class Axes:
    """The axes of a study, and what is wrong with them.

    tables: the values of each by key.  file: of points, which has the values.
    """

    def __init__(
        self, case: Case, tables: Sequence[Mapping[str, Any]], sampling: Any, file: PointsFile | None = None
    ) -> None:
        self.mistakes: list[Mistake] = []
        self._sampling, self._file = sampling, file
        self._wrong_cells: list[tuple[int, str]] = []
        own = len(tables)
        if file:
            tables = tables_of(file, tables)
        self._lattice = lattice_of(case)
        self._fields: list[tuple[int, str, Field]] = []
        axes = [(k, axis) for k, table in enumerate(tables) if (axis := self._axis(case, k, table))]
        self.mistakes += [*self._doubled(), *_unlike(axes, sampling)]
        if file:
            self.mistakes = [_of_column(mistake, own, tables, file) for mistake in self.mistakes]
            wrong = [*file.mistakes, *file.by_line(self._wrong_cells)]
            self.mistakes += [(("study", "points"), message) for message in wrong]
        # What the plate depends on varies slowest: points that follow each other share it.
        self.axes = tuple(sorted((axis for _, axis in axes), key=lambda axis: not is_deep(case, axis)))

    def _axis(self, case: Case, k: int, table: Mapping[str, Any]) -> Axis | None:
        try:
            field = find_field(case, self._lattice[0], table["field"])
        except ValueError as error:
            self.mistakes.append((("axes", k, "field"), str(error)))
            return None
        self._fields.append((k, table["name"] or field.path, field))
        if self._file:
            return self._from_file(self._file, k, field, table)
        key = "values" if table["values"] is not None else "range"
        values, wrong = _read(field, table[key])
        if wrong:
            self.mistakes += [(("axes", k, key, place), message) for place, message in wrong]
        elif mistakes := list(self._misfits(field, key, values, table)):
            self.mistakes += [(("axes", k, at), message) for at, message in mistakes]
        else:
            return self._made(field, key, values, table)
        return None

    def _from_file(self, file: PointsFile, k: int, field: Field, table: Mapping[str, Any]) -> Axis | None:
        if table["values"] is None:
            if file.columns:
                names = ", ".join(column.name for column in file.columns)
                self.mistakes.append((("axes", k, "field"), f"must be a column of {file.name}, which has {names}"))
            return None
        values, wrong = file.read(field, table["values"])
        self._wrong_cells += wrong
        return None if wrong else Axis(table["name"] or field.path, field, tuple(values))

    def _made(self, field: Field, key: str, values: list[Any], table: Mapping[str, Any]) -> Axis:
        name, logarithmic = table["name"] or field.path, table["spacing"] == "logarithmic"
        if key == "values":
            return Axis(name, field, tuple(values))
        if table["count"] is None:
            return Axis(name, field, (), values[0], values[1], logarithmic)
        return Axis(name, field, spaced(values[0], values[1], table["count"], logarithmic), logarithmic=logarithmic)

    def _misfits(
        self, field: Field, key: str, values: list[Any], table: Mapping[str, Any]
    ) -> Iterator[tuple[str, str]]:
        """What does not fit the field or the sampling, by key."""
        drawn = self._sampling in ("random", "sobol")
        if key == "values":
            doubled = next((value for value, count in Counter(values).items() if count > 1), None)
            if doubled is not None and self._sampling == "grid":
                yield "values", f"must differ from each other; got {counted(quoted(doubled), field.unit)} twice"
            return
        if field.kind != "number":
            yield "range", f"must not be given for {field.path}, which has no values in between; list its values"
        elif values[0] == values[1]:
            yield "range", "must have a last value that differs from the first"
        elif table["spacing"] == "logarithmic" and not (values[0] > 0 and values[1] > 0):
            yield "range", 'must have values above 0 with spacing = "logarithmic"'
        if not drawn and table["count"] is None:
            yield "count", f'is missing; with sampling = "{self._sampling}" a range needs a count of values'
        if drawn and table["count"] is not None:
            yield "count", f'must not be given with sampling = "{self._sampling}", which draws from all of a range'
        if table["count"] == 1:
            yield "count", "must be at least 2 for a range; got 1"

    def _doubled(self) -> Iterator[Mistake]:
        """What two axes both have."""
        makes = next((field.path for *_, field in self._fields if field.locations[0][0] == "lattice"), None)
        alone = self._lattice[1]
        for n, (k, name, field) in enumerate(self._fields):
            numbers = [int(at[1]) for at in field.locations if at[0] == "actuators"]
            if makes and numbers and max(numbers) >= alone:
                yield ("axes", k, "field"), f"must not vary actuators from {alone} on: the axis over {makes} makes them"
            for _, other, varied in self._fields[:n]:
                if shared := _within(field, varied) | _within(varied, field):
                    at = ".".join(map(str, min(shared, key=str)))
                    same = f"{at} is varied by the axis {other} already"
                    yield ("axes", k, "field"), f"must be varied by one axis only; {same}"
                elif name == other:
                    yield ("axes", k, "name"), f"must differ from that of another axis; got {quoted(name)} twice"


def _of_column(mistake: Mistake, own: int, tables: Sequence[Mapping[str, Any]], file: PointsFile) -> Mistake:
    """A mistake about an axis that only the file has, as one of the file."""
    (_, k, *_), message = mistake
    if not isinstance(k, int) or k < own:
        return mistake
    name = tables[k]["field"]
    meant = near(name, [str(word) for table in tables[:own] for word in (table["name"], table["field"]) if word])
    (told,) = file.told([f"column {quoted(name)} {f'is not known; did you mean {meant}?' if meant else message}"])
    return ("study", "points"), told


def _within(field: Field, other: Field) -> set[Location]:
    """The locations of a field that another one has, or has as part of what it varies."""
    known = set(other.locations)
    return {at for at in field.locations if any(at[:n] in known for n in range(1, len(at) + 1))}


def _read(field: Field, written: Sequence[Any]) -> tuple[list[Value], list[tuple[int, str]]]:
    values, wrong = [], []
    for place, value in enumerate(written):
        try:
            values.append(field.read(value))
        except ValueError as error:
            wrong.append((place, str(error)))
    return values, wrong


def _unlike(axes: Sequence[tuple[int, Axis]], sampling: Any) -> Iterator[Mistake]:
    """What in a list has not as many values as the first axis."""
    for k, axis in axes[1:] if sampling == "list" else ():
        count = len(axes[0][1].values)
        if len(axis.values) != count:
            key = "values"
            yield ("axes", k, key), f'must be as many as those of the first axis with sampling = "list", {count}'
