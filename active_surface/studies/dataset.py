"""The results of a sweep as one netCDF file with labelled axes, which xarray reads; it is HDF5."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import h5netcdf
import h5py
import numpy as np

from active_surface.arrays import FloatArray
from active_surface.studies.axis import Axis
from active_surface.studies.record import COLUMNS, KIND, OUTCOMES, SENTENCES, Records
from active_surface.studies.stored import AT_ONCE, KIND_ATTRIBUTE, slabs, stored_records
from active_surface.studies.study import Study, versions
from active_surface.studies.variants import heights_key
from coupling import check_room, whole_file
from coupling.case import Case, PlateCase
from meshes import rim_curves

if TYPE_CHECKING:
    import xarray


ENGINE: Final = "h5netcdf"
LOGARITHMIC: Final = "logarithmic"
LABELS: Final = ("axes", "study", "case")  # attributes that say how the numbers are labelled and described
RIM_PIECES: Final = 200  # of the longer side of the plate's box: how fine the rim is
ROOM: Final = 1_000_000  # bytes, for what does not grow with the points


def write_dataset(
    study: Study, chunks: Iterable[tuple[int, Records]], path: Path, warnings: Sequence[str] = ()
) -> Path:
    """Write the records of a study to the file at `path`, chunk by chunk; returns that path once it is safe on disk.

    chunks: the number of each chunk's first path, and the records.  warnings: texts for the user, kept with them.
    Raises OSError when the disk has no room.
    """
    _check_room(study, path.parent)
    with whole_file(path, path.with_suffix(f".partial{path.suffix}"), synced=True) as partial:
        _write(study, chunks, partial, warnings)
    return path


def renew_labels(study: Study, path: Path) -> None:
    """Rewrite the file at `path`, which holds the numbers of a study, if it labels or describes them otherwise."""
    about = _about(study)
    with h5netcdf.File(path, "r") as file:
        described = LABELS if study.source else LABELS[:1]
        if all(file.attrs[name] == about[name] for name in described):
            return
        warnings = str(file.attrs["warnings"]).splitlines()
    write_dataset(study, stored_records(path), path, warnings)


def _write(study: Study, chunks: Iterable[tuple[int, Records]], path: Path, warnings: Sequence[str]) -> None:
    with h5netcdf.File(path, "w") as file:
        _fill_in(file, study, chunks, warnings)


def _fill_in(file: h5netcdf.File, study: Study, chunks: Iterable[tuple[int, Records]], warnings: Sequence[str]) -> None:
    sizes = study.points.dimensions
    file.dimensions = sizes
    file.attrs.update(_about(study), warnings="\n".join(warnings))
    _write_axes(file, study)
    for name, column in COLUMNS.items():
        variable = file.create_variable(name, tuple(sizes), column.kind, fillvalue=_fill(column.kind))
        variable.attrs["long_name"] = column.meaning
        variable.attrs["coordinates"] = " ".join(axis.name for axis in study.points.axes)
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


def _check_room(study: Study, folder: Path) -> None:
    """Raise OSError unless a folder has room for the results."""
    count = len(study.points)
    coordinates = 0 if study.points.sampling == "grid" else 8 * len(study.points.axes) * count // study.points.repeats
    # Twice: while they are put in order they are on disk once more.
    needed = 2 * KIND.itemsize * count + coordinates + ROOM
    check_room(folder, needed, "; finished chunks are kept, and the same command goes on from them")


def _fill(kind: str) -> float | None:
    return float("nan") if kind == "f8" else None


def _about(study: Study) -> dict[str, Any]:
    return {
        "kind": KIND_ATTRIBUTE,
        "key": study.key,
        "traits": json.dumps(study.traits),
        "study": study.source,
        "case": study.case.source or study.case.model_dump_json(),
        "versions": json.dumps(versions()),
        "sampling": study.points.sampling,
        "stream": json.dumps(study.points.stream),
        "heights": heights_key(study),
        "axes": " ".join(axis.name for axis in study.points.axes),
        "actuators": np.array([c for actuator in study.case.actuators for c in actuator.position], dtype=float),
        "rim": _rim(study.case).ravel(),
    }


def _rim(case: Case) -> FloatArray:
    """The curves of the plate's rim (n, 2) [m], with nan after each; empty: there is a platform."""
    if not isinstance(case.plate, PlateCase):
        return np.empty((0, 2))
    outline = case.plate.coarse_mesh.outline
    curves = rim_curves(outline, float(np.ptp(outline.box, axis=0).max()) / RIM_PIECES)
    return np.concatenate([np.append(curve, [[np.nan, np.nan]], axis=0) for curve in curves])


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
        for variable, values in zip(variables, points.columns(range(first, last)), strict=True):
            variable[first:last] = values


def _axis(file: h5netcdf.File, axis: Axis, dimension: str) -> h5netcdf.Variable:
    kind = h5py.string_dtype() if axis.kind is object else axis.kind
    variable = file.create_variable(axis.name, (dimension,), kind)
    variable.attrs["field"] = axis.field.path
    if axis.field.unit:
        variable.attrs["units"] = axis.field.unit
    if axis.logarithmic:
        variable.attrs["spacing"] = LOGARITHMIC
    return variable


def read_dataset(path: Path, axes: Sequence[str] | None = None) -> xarray.Dataset:
    """The results of a sweep, read from the file on demand until the dataset is closed.

    axes: new names for the axes, in their order; None: those in the file.
    """
    import xarray

    dataset = xarray.open_dataset(path, engine=ENGINE)
    if axes is None or dataset.attrs["axes"] == " ".join(axes):
        return dataset
    names = dict(zip(dataset.attrs["axes"].split(), axes, strict=True))
    renamed = dataset.rename(names).assign_attrs(axes=" ".join(axes))
    renamed.set_close(dataset.close)
    return renamed
