"""The results of a sweep as one netCDF file with labelled axes, which xarray reads; it is HDF5."""

from __future__ import annotations

import hashlib
import json
import math
import tomllib
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import h5netcdf
import h5py
import numpy as np

from active_surface.arrays import FloatArray
from active_surface.studies.axes import Axis
from active_surface.studies.columns import COLUMNS, KIND, OUTCOMES, SENTENCES, Records
from active_surface.studies.points import Points
from active_surface.studies.study import Study, versions
from common import UNREADABLE, check_hdf5, survives
from coupling import check_room, whole_file
from coupling.case import Case, PlateCase, find_field, lattice_of
from meshes import rim_curves

if TYPE_CHECKING:
    import xarray

ENGINE: Final = "h5netcdf"
SWEEP: Final = "active-surface sweep"
LOGARITHMIC: Final = "logarithmic"
LABELS: Final = ("axes", "study", "case")  # attributes that say how the numbers are labelled and described
AT_ONCE: Final = 65536  # records that are read or written together, about
RIM_PIECES: Final = 200  # of the longer side of the plate's box: how fine the rim is
INDEX: Final = 32  # bytes a path, about, by which the table of finished paths grows when it is read in order
ROOM: Final = 1_000_000  # bytes, for what does not grow with the points
Slab = tuple[slice, ...]


class _DamageError(ValueError):
    """What is wrong with a file, in our words."""


def write_sweep(study: Study, lots: Iterable[Records], path: Path, warnings: Sequence[str] = ()) -> Path:
    """Write the records of a study to the file at `path`; returns that path once it is safe on disk.

    lots: the records in the order of their paths, as many at a time as `slabs` says.  warnings: texts for the user,
    kept with them.  Raises OSError when the disk has no room.
    """
    points = study.points
    coordinates = 0 if points.sampling == "grid" else 8 * len(points.axes) * len(points) // points.repeats
    needed = (KIND.itemsize + INDEX) * len(points) + coordinates + ROOM
    check_room(path.parent, needed, "; finished paths are kept, and the same command goes on from them")
    sizes = points.dimensions
    with (
        whole_file(path, path.with_suffix(f".partial{path.suffix}"), synced=True) as partial,
        h5netcdf.File(partial, "w") as file,
    ):
        file.dimensions = sizes
        file.attrs.update(_about(study), warnings="\n".join(warnings))
        _write_axes(file, points)
        for name, column in COLUMNS.items():
            fill = float("nan") if column.kind == "f8" else None
            variable = file.create_variable(name, tuple(sizes), column.kind, fillvalue=fill)
            variable.attrs["long_name"] = column.meaning
            variable.attrs["coordinates"] = " ".join(axis.name for axis in points.axes)
            if column.unit:
                variable.attrs["units"] = column.unit
        file["outcome"].attrs.update(
            flag_values=np.arange(len(OUTCOMES), dtype="i1"),
            flag_meanings=" ".join(outcome.replace(" ", "_") for outcome in OUTCOMES),
            sentences="\n".join(SENTENCES),
        )
        for slab, records in zip(slabs(points.shape), lots, strict=True):
            shape = [piece.stop - piece.start for piece in slab]
            for name in COLUMNS:
                file[name][slab] = records[name].reshape(shape)
    return path


def renew_labels(study: Study, path: Path) -> None:
    """Rewrite the file at `path`, which has the numbers of a study, if it labels or describes them otherwise."""
    about = _about(study)
    with h5netcdf.File(path, "r") as file:
        described = LABELS if study.source else LABELS[:1]
        if all(file.attrs[name] == about[name] for name in described):
            return
        warnings = str(file.attrs["warnings"]).splitlines()
    write_sweep(study, _records(path), path, warnings)


def _about(study: Study) -> dict[str, Any]:
    return {
        "kind": SWEEP,
        "key": study.key,
        "traits": json.dumps(study.traits),
        "study": study.source,
        "case": study.case.source or study.case.model_dump_json(),
        "versions": json.dumps(versions()),
        "sampling": study.points.sampling,
        "stream": json.dumps(study.points.stream),
        "heights": study.heights,
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


def _write_axes(file: h5netcdf.File, points: Points) -> None:
    """The coordinates: of a grid a dimension each, else all along the points."""
    if points.sampling == "grid":
        for axis in points.axes:
            _axis(file, axis, axis.name)[...] = axis.array
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


def slabs(shape: Sequence[int]) -> Iterator[Slab]:
    """Yield boxes that make up an array, in order, each of at most AT_ONCE elements."""
    inner = math.prod(shape[1:])
    if inner > AT_ONCE:
        for k in range(shape[0]):
            yield from ((slice(k, k + 1), *slab) for slab in slabs(shape[1:]))
        return
    step = AT_ONCE // inner
    for first in range(0, shape[0], step):
        yield (slice(first, min(first + step, shape[0])), *(slice(0, count) for count in shape[1:]))


def _records(path: Path) -> Iterator[Records]:
    """Yield the records in a file in the order of their paths, as many at a time as `slabs` says."""
    with h5netcdf.File(path, "r") as file:
        for slab in slabs(file["outcome"].shape):
            records = np.empty(math.prod(piece.stop - piece.start for piece in slab), KIND)
            for name in COLUMNS:
                records[name] = file[name][slab].ravel()
            yield records


@contextmanager
def whole(path: Path) -> Iterator[None]:
    """Raise ValueError, which names the file, where what is read from it in the block is not as it must be."""
    try:
        yield
    except UNREADABLE as error:
        what = str(error) if isinstance(error, _DamageError) else "it cannot be read to its end"
        raise ValueError(f"{path}: is a sweep that is damaged: {what}; remove it and sweep again") from error


def key_of(path: Path) -> str | None:
    """The key of the study whose results a file has; None: there is no such file.

    Raises ValueError when the results are damaged.
    """
    if not path.is_file() or not survives(path):
        return None
    try:
        with h5py.File(path, "r") as file:  # h5netcdf prints a traceback where it cannot open one
            if file.attrs.get("kind") != SWEEP:
                return None
    except UNREADABLE:
        return None
    with whole(path):
        return _checked_key(path)


def _checked_key(path: Path) -> str:
    """The key; raises _DamageError, or any of UNREADABLE, where the file is not as `write_sweep` makes it."""
    try:
        check_hdf5(path)
    except UnicodeError:
        raise
    except ValueError as error:
        raise _DamageError(str(error)) from None
    with h5netcdf.File(path, "r") as file:
        texts = {name: file.attrs[name] for name in ("key", "study", "case", "sampling", "axes")}
        if not all(isinstance(text, str) for text in texts.values()):
            raise _DamageError("a text in it is none")
        for name, kind in {"traits": dict, "versions": dict, "stream": list}.items():
            if name in file.attrs and not isinstance(json.loads(file.attrs[name]), kind):
                raise _DamageError(f"its {name} are no {kind.__name__}")
        tomllib.loads(texts["study"])
        for name in ("rim", "actuators"):
            numbers = np.asarray(file.attrs.get(name, []))
            if numbers.ndim > 1 or (numbers.size and numbers.dtype.kind != "f") or numbers.size % 2:
                raise _DamageError(f"its {name} has no places")
        shape, names = file["outcome"].shape, texts["axes"].split()
        if 0 in shape:
            raise _DamageError("it has no points")
        for number, name in enumerate(names):
            values = file[name]
            count = shape[number if texts["sampling"] == "grid" else 0]
            if not isinstance(values.attrs["field"], str) or values.shape != (count,):
                raise _DamageError(f"its axis {name} does not fit its results")
            if values.dtype.kind == "f" and not np.isfinite(values[...]).all():
                raise _DamageError(f"its axis {name} has a number that is not finite")
        for name, column in COLUMNS.items():
            if file[name].shape != shape or np.dtype(file[name].dtype) != np.dtype(column.kind):
                raise _DamageError(f"its {name} does not fit its outcomes")
    for records in _records(path):
        if not ((records["outcome"] >= 0) & (records["outcome"] < len(OUTCOMES))).all():
            raise _DamageError("it has an outcome that there is not")
    return str(texts["key"])


def differences(study: Study, path: Path) -> list[str]:
    """In what a study differs from the one whose results a file has."""
    with h5netcdf.File(path, "r") as file:
        known = json.loads(file.attrs.get("traits", "{}"))
    return [name for name, trait in study.traits.items() if known.get(name) != trait]


def keys_of(study: Study) -> Iterator[bytes]:
    """Yield a digest of what each path of a study follows from."""
    points, base = study.points, _base(study.traits, study.points.stream, study.heights)
    for first in range(0, len(points), AT_ONCE):
        yield from points.keys(range(first, min(first + AT_ONCE, len(points))), base)


def finished_paths(study: Study, path: Path) -> Iterator[tuple[list[bytes], Records]]:
    """Yield the paths in a file that a study may have, too: their digests, as of `keys_of`, and their records.

    There are none if the file is of another case, or if its paths share something else that they follow from.
    """
    with h5netcdf.File(path, "r") as file:
        about = file.attrs
        if not {"traits", "stream", "heights"} <= set(about):
            return
        traits, stream, heights = json.loads(about["traits"]), json.loads(about["stream"]), str(about["heights"])
        base = _base(traits, stream, heights)
        if base != _base(study.traits, study.points.stream, study.heights):
            return
        lattice, _ = lattice_of(study.case)
        axes = []
        for name in str(about["axes"]).split():
            field, values = find_field(study.case, lattice, str(file[name].attrs["field"])), file[name][...].tolist()
            texts = (value.decode() if isinstance(value, bytes) else value for value in values)
            axes.append(Axis(name, field, tuple(texts)))
        repeats = file.dimensions["repeat"].size if "repeat" in file.dimensions else 1
        count = len(axes[0].values)
        sampling: Any = about["sampling"]
    points = Points(tuple(axes), sampling, count, repeats, study.points.jitter, study.points.seed, listed=True)
    first = 0
    for records in _records(path):
        yield points.keys(range(first, first + len(records)), base), records
        first += len(records)


def _base(traits: dict[str, str], stream: Sequence[float | None], heights: str) -> bytes:
    """What all paths of a study follow from, beside their points."""
    shared = {name: trait for name, trait in traits.items() if name != "points"}
    return hashlib.sha256(json.dumps([shared, stream, heights], sort_keys=True).encode()).digest()


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
