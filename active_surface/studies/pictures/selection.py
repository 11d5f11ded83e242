"""Selection: what of a sweep's results its picture shows; all of it is in the file of the results."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydantic import TypeAdapter

from active_surface.arrays import BoolArray, FloatArray, IntArray
from active_surface.studies.axes import Axis, counted
from active_surface.studies.columns import COLUMNS, OUTCOMES, Threshold, read_threshold
from active_surface.studies.points import longest
from active_surface.studies.sweep_file import LOGARITHMIC, key_of, read_dataset, whole
from common import Unit, unit_for
from coupling import near
from coupling.case import Field

if TYPE_CHECKING:
    import xarray

DISTANCE = "distance"
NUMBER = "number of the path"  # with spaces, which no axis has in its name
MAX_POINTS = 100_000  # of random ones
NAMED = "m", "s", "N", "Hz", "m/s", "Pa"
"""Units that take a prefix."""
UNEVEN = 4.0
"""Listed values whose largest step is more times the smallest one are not drawn at their places."""


@dataclass(frozen=True, eq=False)
class Findings:
    """The results of a sweep with the condition whose beginning is drawn, if there is one."""

    name: str
    dataset: xarray.Dataset
    threshold: Threshold | None
    axes: tuple[Axis, ...]  # without values where they run along the points

    @classmethod
    def of(cls, name: str, dataset: xarray.Dataset, threshold: Threshold | None) -> Findings:
        """The findings in the results of a sweep."""
        grid = dataset.attrs["sampling"] == "grid"
        axes = tuple(_axis(dataset[axis], grid) for axis in dataset.attrs["axes"].split())
        return cls(name, dataset, threshold, axes)

    @property
    def scattered(self) -> bool:
        """Whether the results are at points, not on a grid."""
        return bool(self.dataset.attrs["sampling"] != "grid")

    @property
    def repeats(self) -> int:
        """How many paths there are of each point."""
        return int(self.dataset.sizes.get("repeat", 1))

    @property
    def actuators(self) -> FloatArray:
        """Their places (N, 2) [m]."""
        return np.reshape(self.dataset.attrs["actuators"], (-1, 2))

    @property
    def rim(self) -> FloatArray:
        """The curves of the plate's rim (n, 2) [m], with nan after each; empty: there is a platform."""
        return np.reshape(self.dataset.attrs["rim"], (-1, 2))


@contextmanager
def read_findings(path: Path) -> Iterator[Findings]:
    """Yield the findings in a file that a sweep left, which is closed at the end; ValueError when it is none."""
    if key_of(path) is None:
        raise ValueError(f"{path}: must be the netCDF file of a sweep; it is not")
    with whole(path):
        dataset = read_dataset(path)
    with dataset:
        if not {"axes", "rim"} <= dataset.attrs.keys():
            raise ValueError(f"{path}: must be of a sweep by this version of active-surface; it is of an older one")
        with whole(path):
            condition = tomllib.loads(dataset.attrs["study"]).get("map", {}).get("threshold")
            findings = Findings.of(path.stem, dataset, read_threshold(condition) if condition else None)
        yield findings


def _axis(array: xarray.DataArray, listed: bool) -> Axis:
    """The axis that a coordinate is, with its values if they are listed."""
    path, unit = str(array.attrs["field"]), str(array.attrs.get("units", ""))
    field = Field(path, (), unit, "number" if unit else "text", TypeAdapter(Any))
    values = tuple(array.values.tolist()) if listed else ()
    return Axis(str(array.name), field, values, logarithmic=array.attrs.get("spacing") == LOGARITHMIC)


@dataclass(frozen=True, eq=False)
class Scale:
    """An axis of the picture; what has `texts` is drawn at their numbers, which `values` has."""

    axis: Axis
    unit: Unit
    values: FloatArray
    logarithmic: bool = False
    texts: tuple[str, ...] = ()

    @classmethod
    def of(cls, axis: Axis, values: NDArray[Any]) -> Scale:
        """The scale of an axis with values (n,) in SI units, or texts."""
        if axis.field.kind == "text":
            texts = tuple(dict.fromkeys(map(str, values)))
            return cls(axis, Unit("", 1.0), np.array([texts.index(str(value)) for value in values], float), texts=texts)
        numbers = np.asarray(values, dtype=float)
        return cls(axis, _unit(numbers, axis.field.unit), numbers, axis.logarithmic)

    def in_cells(self) -> Scale:
        """The same of ascending values with no cell that is much narrower than others.

        Where steps are uneven, but ratios are not, it is logarithmic; else all cells are as wide, and named.
        """
        if self.texts or self.logarithmic or _even(self.values):
            return self
        if self.values[0] > 0 and _even(np.log(self.values)):
            return replace(self, logarithmic=True)
        names = tuple(number_text(value, self.drawn, 6) for value in self.drawn)
        return replace(self, unit=Unit(self.unit.name, 1.0), values=np.arange(len(names), dtype=float), texts=names)

    @property
    def label(self) -> str:
        """The name of the axis, with the unit."""
        return labelled(self.axis.name, self.unit)

    @property
    def drawn(self) -> FloatArray:
        """Its values in its unit."""
        return self.values * self.unit.per_si


@dataclass(frozen=True, eq=False)
class Selection:
    """Results along at most two axes of a grid, or at points; repeats are along the last dimension.

    Numbers along an axis of a grid ascend.

    fixed: the values of axes that are not shown, in words.  holds: where the threshold holds, if there is one.
    """

    findings: Findings
    axes: tuple[Scale, ...]
    column: str
    value: FloatArray  # of the column in SI units, nan where refused
    distance: FloatArray  # m, nan where refused
    outcome: IntArray
    end: FloatArray  # (..., 2) m
    fixed: dict[str, str]
    numbers: IntArray  # of the paths
    holds: BoolArray | None = None

    @classmethod
    def of(cls, findings: Findings, x: str | None = None, y: str | None = None, column: str | None = None) -> Selection:
        """What is shown over the axes named x and y, by default the longest, of a column of the results.

        Raises ValueError, naming all of them, for names that there are not.
        """
        axes, column = _chosen(findings, x, y, column or DISTANCE), column or DISTANCE
        dims = ["point"] if findings.scattered else [axis.name for axis in axes]
        outcome, fixed = findings.dataset["outcome"], {}
        part = findings.dataset.assign({NUMBER: (outcome.dims, np.arange(outcome.size).reshape(outcome.shape))})
        if findings.scattered:
            part = part.isel(point=slice(0, MAX_POINTS))
        else:
            part = part.sortby([axis.name for axis in findings.axes if axis.field.kind != "text"])
            for axis in (one for one in findings.axes if one not in axes):
                part = part.isel({axis.name: len(axis.values) // 2})
                fixed[axis.name] = _fixed(axis, part[axis.name].values)
            part = part.transpose(*dims, ...)
        shape = [part.sizes[name] for name in dims]
        names = (column, DISTANCE, "outcome", "end_x", "end_y", NUMBER)
        arrays = {name: part[name].values.reshape(*shape, -1) for name in names}
        scales = tuple(Scale.of(axis, part[axis.name].values) for axis in axes)
        return cls(
            findings,
            scales if findings.scattered else tuple(scale.in_cells() for scale in scales),
            column,
            arrays[column].astype(float),
            arrays[DISTANCE],
            arrays["outcome"].astype(np.int64),
            np.stack([arrays["end_x"], arrays["end_y"]], axis=-1),
            fixed,
            arrays[NUMBER],
            findings.threshold and findings.threshold.holds(part, findings.repeats),
        )

    @property
    def meaning(self) -> str:
        """What the column is."""
        return "distance from the start" if self.column == DISTANCE else COLUMNS[self.column].meaning

    @property
    def unit(self) -> Unit:
        """The unit that its known values take."""
        known = self.value[np.isfinite(self.value)]
        return _unit(known if known.size else np.zeros(1), COLUMNS[self.column].unit)

    @property
    def label(self) -> str:
        """What the column is, with the unit."""
        return labelled(self.meaning, self.unit)

    @property
    def mean_value(self) -> FloatArray:
        """The mean over repeats in SI units; nan where all were refused."""
        return mean(self.value)

    @property
    def mean_distance(self) -> FloatArray:
        """The mean over repeats [m]; nan where all were refused."""
        return mean(self.distance)

    @property
    def usual_outcome(self) -> IntArray:
        """The most frequent outcome of the repeats, of two that are as frequent that with the lower number."""
        return np.argmax([(self.outcome == k).sum(axis=-1) for k in range(len(OUTCOMES))], axis=0)


def _chosen(findings: Findings, x: str | None, y: str | None, column: str) -> tuple[Axis, ...]:
    """The axes named x and y; of those that are not named the longest, or the first two along the points."""
    named = {axis.name: axis for axis in findings.axes}
    mistakes = []
    for key, name, known in (("x", x, list(named)), ("y", y, list(named)), ("value", column, list(COLUMNS))):
        if name is not None and name not in known:
            meant = near(name, known)
            hint = f"; did you mean {meant}?" if meant else ""
            mistakes.append(f"Input {key} must be one of {', '.join(known)}; got {name}{hint}")
    if mistakes:
        raise ValueError("\n".join(mistakes))
    if x is not None and x == y:
        raise ValueError(f"Input y must be another axis than x; got {y} for both")
    if x is None and y is None:
        return findings.axes[:2] if findings.scattered else longest(findings.axes)
    others = sorted((axis for axis in findings.axes if axis.name not in (x, y)), key=lambda axis: -len(axis.values))
    across, up = (named[name] if name else next(iter(others), None) for name in (x, y))
    if across is None:
        raise ValueError(f"Input y must not be given where there is but one axis; got {y}")
    return (across,) if up is None else (across, up)


def mean(values: FloatArray) -> FloatArray:
    """The mean over repeats, the last dimension; nan where none has a value."""
    return np.ma.masked_invalid(values).mean(axis=-1).filled(np.nan)


def labelled(text: str, unit: Unit) -> str:
    """The label of an axis or bar."""
    return text if unit.name in ("", "1") else f"{text} [{unit.name}]"


def number_text(value: float, values: ArrayLike, digits: int) -> str:
    """A number with as many digits, and with more where fewer would not tell it from the others of an axis."""
    steps = np.diff(np.unique(values))
    if len(steps) and value:
        digits = max(digits, 2 + int(np.floor(np.log10(abs(value))) - np.floor(np.log10(steps.min()))))
    return f"{value:.{min(digits, 15)}g}"


def _fixed(axis: Axis, value: NDArray[Any]) -> str:
    """One value of an axis of a grid in words that tell it from the others."""
    scale = Scale.of(axis, np.atleast_1d(value))
    if scale.texts:
        return scale.texts[0]
    text = number_text(float(scale.drawn[0]), np.asarray(axis.values, dtype=float) * scale.unit.per_si, 4)
    return counted(text, scale.unit.name)


def _unit(numbers: FloatArray, si: str) -> Unit:
    if si == "kg" and np.abs(numbers).max() < 1:
        grams = unit_for(1e3 * numbers, "g")
        return Unit(grams.name, 1e3 * grams.per_si)
    return unit_for(numbers, si) if si in NAMED else Unit(si, 1.0)


def _even(values: FloatArray) -> bool:
    steps = np.diff(values)
    return len(steps) < 2 or float(steps.max()) <= UNEVEN * float(steps.min())
