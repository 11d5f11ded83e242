"""Selection: what of a sweep's results its picture shows."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from active_surface.arrays import BoolArray, FloatArray, IntArray
from active_surface.studies.axes import Axis, counted
from active_surface.studies.pictures.findings import Findings
from active_surface.studies.record import COLUMNS, OUTCOMES
from common import Unit, unit_for
from coupling import near

DISTANCE = "distance"
NUMBER = "number of the path"  # with spaces, which no axis has in its name
MAX_POINTS = 100_000  # of random ones
NAMED = "m", "s", "N", "Hz", "m/s", "Pa"
"""Units that take a prefix."""
UNEVEN = 4.0
"""Listed values whose largest step is more times the smallest one are not drawn at their places."""


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
        if axis.field.kind == "text":
            texts = tuple(dict.fromkeys(str(value) for value in values))
            return cls(axis, Unit("", 1.0), np.array([texts.index(str(value)) for value in values], float), texts=texts)
        numbers = np.asarray(values, dtype=float)
        unit = _unit(numbers, axis.field.unit)
        return cls(axis, unit, numbers, axis.logarithmic)

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
        return labelled(self.axis.name, self.unit)

    @property
    def drawn(self) -> FloatArray:
        """Its values in its unit."""
        return self.values * self.unit.per_si


def _unit(numbers: FloatArray, si: str) -> Unit:
    if si == "kg" and np.abs(numbers).max() < 1:
        grams = unit_for(1e3 * numbers, "g")
        return Unit(grams.name, 1e3 * grams.per_si)
    return unit_for(numbers, si) if si in NAMED else Unit(si, 1.0)


def _even(values: FloatArray) -> bool:
    steps = np.diff(values)
    return len(steps) < 2 or float(steps.max()) <= UNEVEN * float(steps.min())


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
        column = column or DISTANCE
        _check_names(findings, x, y, column)
        axes = _chosen(findings, x, y)
        scattered, outcome, fixed = findings.scattered, findings.dataset["outcome"], {}
        numbers = outcome.copy(data=np.arange(outcome.size).reshape(outcome.shape))
        part = findings.dataset.assign({NUMBER: numbers})
        if scattered:
            part = part.isel(point=slice(0, MAX_POINTS))
        else:
            part = part.sortby([axis.name for axis in findings.axes if axis.field.kind != "text"])
            for axis in (one for one in findings.axes if one not in axes):
                part = part.isel({axis.name: len(axis.values) // 2})
                scale = Scale.of(axis, np.atleast_1d(part[axis.name].values))
                fixed[axis.name] = scale.texts[0] if scale.texts else _fixed(scale, axis.values)
            part = part.transpose(*(axis.name for axis in axes), ...)
        arrays = {name: part[name].values for name in (column, DISTANCE, "outcome", "end_x", "end_y", NUMBER)}
        if findings.repeats == 1:
            arrays = {name: array[..., None] for name, array in arrays.items()}
        scales = tuple(Scale.of(axis, part[axis.name].values) for axis in axes)
        return cls(
            findings,
            scales if scattered else tuple(scale.in_cells() for scale in scales),
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
        counts = np.stack([(self.outcome == k).sum(axis=-1) for k in range(len(OUTCOMES))])
        return np.argmax(counts, axis=0)


def number_text(value: float, values: ArrayLike, digits: int) -> str:
    """A number with as many digits, and with more where fewer would not tell it from the others of an axis."""
    steps = np.diff(np.unique(values))
    if len(steps) and value:
        digits = max(digits, 2 + int(np.floor(np.log10(abs(value))) - np.floor(np.log10(steps.min()))))
    return f"{value:.{min(digits, 15)}g}"


def _fixed(scale: Scale, values: tuple[Any, ...]) -> str:
    """The only value of a scale in words, beside the other values of its axis [SI]."""
    text = number_text(float(scale.drawn[0]), np.asarray(values, dtype=float) * scale.unit.per_si, 4)
    return counted(text, scale.unit.name)


def mean(values: FloatArray) -> FloatArray:
    """The mean over repeats; nan where none has a value."""
    known = np.isfinite(values)
    total, count = np.where(known, values, 0.0).sum(axis=-1), known.sum(axis=-1)
    return np.divide(total, count, out=np.full(total.shape, np.nan), where=count > 0)


def labelled(text: str, unit: Unit) -> str:
    """The label of an axis or bar."""
    return text if unit.name in ("", "1") else f"{text} [{unit.name}]"


def _chosen(findings: Findings, x: str | None, y: str | None) -> tuple[Axis, ...]:
    """The axes named x and y; of those that are not named the longest."""
    named = {axis.name: axis for axis in findings.axes}
    if x is not None and x == y:
        raise ValueError(f"Input y must be another axis than x; got {y} for both")
    if x is None and y is None:
        return findings.longest
    others = sorted((axis for axis in findings.axes if axis.name not in (x, y)), key=lambda axis: -len(axis.values))
    across, up = (named[name] if name else next(iter(others), None) for name in (x, y))
    if across is None:
        raise ValueError(f"Input y must not be given where there is but one axis; got {y}")
    return (across,) if up is None else (across, up)


def _check_names(findings: Findings, x: str | None, y: str | None, column: str) -> None:
    axes: list[str] = [axis.name for axis in findings.axes]
    mistakes = []
    for key, name, known in (("x", x, axes), ("y", y, axes), ("value", column, list(COLUMNS))):
        if name is not None and name not in known:
            meant = near(name, known)
            hint = f"; did you mean {meant}?" if meant else ""
            mistakes.append(f"Input {key} must be one of {', '.join(known)}; got {name}{hint}")
    if mistakes:
        raise ValueError("\n".join(mistakes))
