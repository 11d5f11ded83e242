"""The results of a sweep as one netCDF file with labelled axes, which xarray reads; it is HDF5."""

from __future__ import annotations

import json
import math
import shutil
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import h5netcdf
import h5py
import numpy as np
from numpy.typing import NDArray

from active_surface.arrays import FloatArray
from active_surface.studies.axis import Axis
from active_surface.studies.heights import heights_key
from active_surface.studies.record import COLUMNS, KIND, OUTCOMES, SENTENCES, Records
from active_surface.studies.study import Study, versions
from coupling import whole_file
from coupling.case import Case, PlateCase
from meshes import rim_curves

if TYPE_CHECKING:
    import xarray


KIND_ATTRIBUTE: Final = "active-surface sweep"
ENGINE: Final = "h5netcdf"
LOGARITHMIC: Final = "logarithmic"
LABELS: Final = ("axes", "study", "case")  # attributes that say how the numbers are labelled and described
RIM_PIECES: Final = 200  # of the longer side of the plate's box: how fine the rim is
AT_ONCE: Final = 65536  # points whose coordinates are written together
ROOM: Final = 1_000_000  # bytes, for what does not grow with the points
Slab = tuple[slice, ...]


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


def stored_records(path: Path) -> Iterator[tuple[int, Records]]:
    """Yield the number of the first path of each lot of records in a file, and the records."""
    with h5netcdf.File(path, "r") as file:
        shape = file["outcome"].shape
        count = math.prod(shape)
        for start in range(0, count, AT_ONCE):
            stop = min(start + AT_ONCE, count)
            records, first = np.empty(stop - start, KIND), 0
            for slab, length in slabs(shape, start, stop):
                for name in COLUMNS:
                    records[name][first : first + length] = file[name][slab].ravel()
                first += length
            yield start, records


def _write(study: Study, chunks: Iterable[tuple[int, Records]], path: Path, warnings: Sequence[str]) -> None:
    sizes = study.points.dimensions
    with h5netcdf.File(path, "w") as file:
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
    """Raise OSError unless a folder has room for the results: HDF5 does not survive a full disk."""
    count = len(study.points)
    coordinates = 0 if study.points.sampling == "grid" else 8 * len(study.points.axes) * count // study.points.repeats
    # Twice: while they are put in order they are on disk once more.
    needed, free = 2 * KIND.itemsize * count + coordinates + ROOM, shutil.disk_usage(folder).free
    if free < needed:
        sizes = f"the results take {needed / 1e6:.1f} MB, and {free / 1e6:.1f} MB are free"
        raise OSError(f"{folder}: {sizes}; finished chunks are kept, and the same command goes on from them")


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


def key_of(path: Path) -> str | None:
    """The key of the study whose results a file holds; None: there is no such file."""
    if not path.is_file():
        return None
    try:
        with h5netcdf.File(path, "r") as file:
            return str(file.attrs["key"]) if file.attrs.get("kind") == KIND_ATTRIBUTE else None
    except OSError:
        return None


def differences(study: Study, path: Path) -> list[str]:
    """In what a study differs from the one whose results a file holds."""
    with h5netcdf.File(path, "r") as file:
        known = json.loads(file.attrs.get("traits", "{}"))
    return [name for name, trait in study.traits.items() if known.get(name) != trait]


class Coordinates(NamedTuple):
    """The points whose results a file holds, as it has them."""

    axes: list[tuple[str, NDArray[Any]]]  # the field of each axis, and its values: of a grid each once
    sampling: str
    repeats: int
    stream: tuple[float, int | None]  # as of `Points`
    heights: str


def stored_coordinates(path: Path) -> Coordinates | None:
    """The points of the results in a file; None: it does not have all of them."""
    with h5netcdf.File(path, "r") as file:
        if not {"stream", "heights"} <= set(file.attrs):
            return None
        variables = [file[name] for name in str(file.attrs["axes"]).split()]
        jitter, seed = json.loads(str(file.attrs["stream"]))
        return Coordinates(
            [(str(variable.attrs["field"]), _plain(variable[...])) for variable in variables],
            str(file.attrs["sampling"]),
            file.dimensions["repeat"].size if "repeat" in file.dimensions else 1,
            (jitter, seed),
            str(file.attrs["heights"]),
        )


def _plain(values: NDArray[Any]) -> NDArray[Any]:
    """Values with texts as Python has them."""
    if values.dtype != object:
        return values
    return np.array([text.decode() if isinstance(text, bytes) else text for text in values], object)


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


def slabs(shape: Sequence[int], start: int, stop: int) -> Iterator[tuple[Slab, int]]:
    """Yield the boxes, in order, that elements start to stop - 1 of an array make up, each with its number of them."""
    if start >= stop:
        return
    if len(shape) == 1:
        yield (slice(start, stop),), stop - start
        return
    inner = math.prod(shape[1:])
    first, last = start // inner, (stop - 1) // inner
    if first == last:
        yield from _within(first, slabs(shape[1:], start - first * inner, stop - first * inner))
        return
    whole_from, whole_to = -(-start // inner), stop // inner
    if start % inner:
        yield from _within(first, slabs(shape[1:], start % inner, inner))
    if whole_to > whole_from:
        rest = tuple(slice(0, n) for n in shape[1:])
        yield (slice(whole_from, whole_to), *rest), (whole_to - whole_from) * inner
    if stop % inner:
        yield from _within(last, slabs(shape[1:], 0, stop % inner))


def _within(index: int, inner: Iterator[tuple[Slab, int]]) -> Iterator[tuple[Slab, int]]:
    for slab, count in inner:
        yield (slice(index, index + 1), *slab), count
