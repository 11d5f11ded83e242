"""The results of a sweep as one netCDF file with labelled axes, which xarray reads; it is HDF5."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import h5netcdf
import numpy as np

from studies.axis import Axis
from studies.record import COLUMNS, OUTCOMES, SENTENCES, Records
from studies.slabs import slabs
from studies.study import Study, versions

if TYPE_CHECKING:
    import xarray

KIND: Final = "active-surface sweep"
ENGINE: Final = "h5netcdf"
AT_ONCE: Final = 65536  # points whose coordinates are written together


def write_dataset(study: Study, chunks: Iterable[tuple[int, Records]], path: Path) -> Path:
    """Writes the records of a study to the file at `path`, chunk by chunk, and returns that.

    chunks: the number of each chunk's first path, and the records.
    """
    partial = path.with_suffix(f".partial{path.suffix}")
    sizes = study.points.dimensions
    with h5netcdf.File(partial, "w") as file:
        file.dimensions = sizes
        file.attrs.update(_about(study))
        _write_axes(file, study)
        for name, column in COLUMNS.items():
            variable = file.create_variable(name, tuple(sizes), column.kind, fillvalue=_fill(column.kind))
            variable.attrs["long_name"] = column.meaning
            if column.unit:
                variable.attrs["units"] = column.unit
        file["outcome"].attrs.update(
            flag_values=np.arange(len(OUTCOMES), dtype="i1"),
            flag_meanings=" ".join(outcome.replace(" ", "_") for outcome in OUTCOMES),
            sentences="\n".join(SENTENCES),
        )
        for start, records in chunks:
            first = 0
            for slab, count in slabs(tuple(sizes.values()), start, start + len(records)):
                shape = [piece.stop - piece.start for piece in slab]
                for name in COLUMNS:
                    file[name][slab] = records[name][first : first + count].reshape(shape)
                first += count
    os.replace(partial, path)
    return path


def _fill(kind: str) -> float | None:
    return float("nan") if kind == "f8" else None


def _about(study: Study) -> dict[str, Any]:
    return {
        "kind": KIND,
        "key": study.key,
        "study": study.source,
        "case": study.case.source or study.case.model_dump_json(),
        "versions": json.dumps(versions()),
        "sampling": study.points.sampling,
        "actuators": np.array([c for actuator in study.case.actuators for c in actuator.position], dtype=float),
    }


def _write_axes(file: h5netcdf.File, study: Study) -> None:
    """The coordinates: of a grid a dimension each, else all along the points."""
    points = study.points
    if points.sampling == "grid":
        for axis in points.axes:
            _axis(file, axis, axis.name)[...] = np.array(axis.values, axis.kind)
        return
    count = points.dimensions["point"]
    variables = [_axis(file, axis, "point") for axis in points.axes]
    for first in range(0, count, AT_ONCE):
        last = min(first + AT_ONCE, count)
        for variable, values in zip(variables, points.columns(first, last), strict=True):
            variable[first:last] = values


def _axis(file: h5netcdf.File, axis: Axis, dimension: str) -> h5netcdf.Variable:
    kind = h5netcdf.core.h5py.string_dtype() if axis.kind is object else axis.kind
    variable = file.create_variable(axis.name, (dimension,), kind)
    variable.attrs["field"] = axis.field.path
    if axis.field.unit:
        variable.attrs["units"] = axis.field.unit
    return variable


def key_of(path: Path) -> str | None:
    """The key of the study whose results a file holds; None: there is no such file."""
    if not path.is_file():
        return None
    try:
        with h5netcdf.File(path, "r") as file:
            return str(file.attrs["key"]) if file.attrs.get("kind") == KIND else None
    except OSError:
        return None


def read_dataset(path: Path) -> xarray.Dataset:
    """The results of a sweep."""
    import xarray

    found = xarray.open_dataset(path, engine=ENGINE)
    axes = [name for name, variable in found.variables.items() if "field" in variable.attrs]
    return found.set_coords(axes)
