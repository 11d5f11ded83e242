"""Export: a saved run in other formats, for programs that cannot read VTKHDF.

Each of NAME.plate and NAME.part becomes NAME.plate.pvd with a folder NAME.plate of VTU files, or NAME.plate.xdmf with
NAME.plate.h5, or a VTKHDF file anew, which closes what an interrupted run left. All have every step and field; of
such a run the first two are called NAME.partial. The part's path may also become NAME.csv, which is always whole.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import h5py
import numpy as np
from numpy.typing import NDArray

from coupling.files import check_room, whole_file
from coupling.progress import ProgressCallback, no_progress
from coupling.results.csv_file import columns_of, is_trajectory, write_columns
from coupling.results.saved import OF_PART, SavedRun
from coupling.results.vtkhdf import GZIP, StepsFile, part_file, plate_file

FORMATS = ("pvd", "xdmf", "vtkhdf", "csv")
VERTEX = np.zeros((1, 1), np.int64)
XDMF_TYPES = {"f": "Float", "i": "Int"}
XDMF_CELLS = {
    "triangle": {"TopologyType": "Triangle"},
    "vertex": {"TopologyType": "Polyvertex", "NodesPerElement": "1"},
}


class Frame(NamedTuple):
    """The plate or the part at one time step."""

    time: float  # s
    points: NDArray[np.float64]  # (n, 3) m
    fields: dict[str, NDArray]  # (n,) or (n, 3)


def export_run(
    saved: SavedRun, folder: str | Path, form: str, tell: ProgressCallback = no_progress
) -> tuple[Path, ...]:
    """Write a saved run to a folder, made if need be, in one of FORMATS; returns the files to open.

    tell: gets how many steps are written, and of how many.
    Raises ValueError for another format, or when VTKHDF files would replace those of the run or NAME.csv something
    that is no path; OSError when a file cannot be written.
    """
    folder = Path(folder)
    if form not in FORMATS:
        raise ValueError(f"Input form of export_run must be one of {', '.join(FORMATS)}; got {form!r}")
    if form == "vtkhdf" and folder.resolve() == saved.part_path.parent.resolve():
        raise ValueError(f"Input output must be another folder than that of the run's own files; got {folder}")
    folder.mkdir(parents=True, exist_ok=True)
    frames = _plate_frames(saved, tell)
    if form == "vtkhdf":
        return _anew(saved, folder, frames)
    if form == "csv":
        path = folder / f"{saved.name}.csv"
        if path.is_file() and not is_trajectory(path):
            free = f"a folder in which {path.name} is free or a trajectory"
            raise ValueError(f"Input output must be {free}; got {folder}")
        last = np.append(np.diff(saved.rows.time) > 0, True)  # each time once, at an event with the values from then on
        return (write_columns(columns_of(saved.rows.chosen(last)), path),)
    write = write_pvd if form == "pvd" else write_xdmf
    name = saved.name if saved.complete else f"{saved.name}.partial"  # as nothing in these files says so
    return (
        write(folder, f"{name}.plate", "triangle", saved.triangles, frames),
        write(folder, f"{name}.part", "vertex", VERTEX, _part_frames(saved)),
    )


def _plate_frames(saved: SavedRun, tell: ProgressCallback) -> Iterator[Frame]:
    points = np.pad(saved.points, ((0, 0), (0, 1)))
    for k, time in enumerate(saved.time.tolist()):
        tell(k, len(saved.time))
        yield Frame(time, points, {name: saved.plate_field(name, k) for name in saved.plate_fields})


def _part_frames(saved: SavedRun) -> Iterator[Frame]:
    for k, time in enumerate(saved.time.tolist()):
        yield Frame(time, saved.position[k : k + 1], {name: getattr(saved, name)[k : k + 1] for name in OF_PART})


def write_pvd(folder: Path, name: str, kind: str, cells: NDArray[np.int64], frames: Iterator[Frame]) -> Path:
    """NAME.pvd and a VTU file for each frame; cells of one kind, "triangle" or "vertex", as meshio calls them."""
    import meshio  # slow to load

    (folder / name).mkdir(exist_ok=True)
    (folder / f"{name}.pvd").unlink(missing_ok=True)  # until all files are those of this run
    root = ET.Element("VTKFile", type="Collection", version="0.1", byte_order="LittleEndian")
    steps = ET.SubElement(root, "Collection")
    for k, frame in enumerate(frames):
        file = Path(name, f"{k:05}.vtu")
        meshio.Mesh(frame.points, [(kind, cells)], frame.fields).write(folder / file, "vtu")
        ET.SubElement(steps, "DataSet", timestep=repr(frame.time), part="0", file=file.as_posix())
    for file in (folder / name).glob("*.vtu"):
        if file.stem.isdigit() and int(file.stem) >= len(steps):  # of a longer run
            file.unlink()
    return _write_xml(root, folder / f"{name}.pvd")


def write_xdmf(folder: Path, name: str, kind: str, cells: NDArray[np.int64], frames: Iterator[Frame]) -> Path:
    """Likewise NAME.xdmf, and NAME.h5 with the numbers."""
    root = ET.Element("Xdmf", Version="3.0")
    steps = ET.SubElement(
        ET.SubElement(root, "Domain"), "Grid", Name=name, GridType="Collection", CollectionType="Temporal"
    )
    with whole_file(folder / f"{name}.h5") as partial:
        with h5py.File(partial, "w") as file:

            def item(grid: ET.Element, element: str, what: dict[str, str], place: str, array: NDArray) -> None:
                """An element of the grid whose numbers are an array, which is written unless its place has one."""
                if place not in file:
                    packed = {"chunks": array.shape, **GZIP} if array.size > 1 else {}
                    file.create_dataset(place, data=array, **packed)
                size, kind_of_number = " ".join(map(str, array.shape)), XDMF_TYPES[array.dtype.kind]
                form = {"Format": "HDF", "DataType": kind_of_number, "Precision": str(array.dtype.itemsize)}
                data = ET.SubElement(ET.SubElement(grid, element, what), "DataItem", form, Dimensions=size)
                data.text = f"{name}.h5:/{place}"

            first: NDArray | None = None
            for k, frame in enumerate(frames):
                check_room(folder, sum(array.nbytes for array in (cells, frame.points, *frame.fields.values())))
                first = frame.points if first is None else first
                grid = ET.SubElement(steps, "Grid", Name=f"step {k}", GridType="Uniform")
                ET.SubElement(grid, "Time", Value=repr(frame.time))
                item(grid, "Topology", {"NumberOfElements": str(len(cells))} | XDMF_CELLS[kind], "cells", cells)
                place = "0/points" if frame.points is first else f"{k}/points"
                item(grid, "Geometry", {"GeometryType": "XYZ"}, place, frame.points)
                for key, array in frame.fields.items():
                    form = "Scalar" if array.ndim == 1 else "Vector"
                    what = {"Name": key, "AttributeType": form, "Center": "Node"}
                    item(grid, "Attribute", what, f"{k}/{key}", array)
        (folder / f"{name}.xdmf").unlink(missing_ok=True)  # which is of the old numbers
    return _write_xml(root, folder / f"{name}.xdmf")


def _write_xml(root: ET.Element, path: Path) -> Path:
    ET.indent(root)
    with whole_file(path) as partial:
        ET.ElementTree(root).write(partial, encoding="utf-8", xml_declaration=True)
    return path


def _anew(saved: SavedRun, folder: Path, frames: Iterator[Frame]) -> tuple[Path, Path]:
    """Both VTKHDF files, with all that those of the run hold."""
    with plate_file(folder, saved.name, saved.points, saved.triangles) as plate:
        _copy(saved.plate_path, plate)
        for frame in frames:
            plate.append(frame.time, **frame.fields)
    with h5py.File(saved.part_path, "r") as file:
        root, k = file["VTKHDF"], len(saved.time)
        points = int(root["NumberOfPoints"][0])
        shape = (k, points) if points > 1 else (k,)
        position = root["Points"][: k * points].reshape(*shape, 3)
        fields = {name: data[: k * points].reshape(*shape, *data.shape[1:]) for name, data in root["PointData"].items()}
    with part_file(folder, saved.name, corners=points - 1) as part:
        _copy(saved.part_path, part)
        part.append(saved.time, position, **fields)
    return folder / f"{saved.name}.plate.vtkhdf", folder / f"{saved.name}.part.vtkhdf"


def _copy(path: Path, into: StepsFile) -> None:
    """What a file holds beside its steps."""
    with h5py.File(path, "r") as file:
        ours = file["active_surface"]
        into.add_metadata(dict(ours.attrs))
        for group, arrays in ours.items():
            into.add_arrays(group, {name: array[()] for name, array in arrays.items()})
