"""Mesh files, as meshio reads them."""

from __future__ import annotations

import io
import re
import warnings
from collections.abc import Iterator
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path
from typing import Any
from xml.etree import ElementTree
from xml.parsers.expat import errors

import numpy as np
from numpy.typing import NDArray

EXPECTED = "Input path of read must be a .msh file of gmsh, a .vtu or a first-order .xdmf file"
FORMATS = {".msh": "gmsh", ".vtu": "vtu", ".xdmf": "xdmf"}
"""The files that are read: what meshio calls them, by their endings."""
DAMAGED = "it is damaged, or its parts do not fit together"
NO_NUMBER = "string or file could not be read to its end"
PARAMETRIC = "its nodes have parameters; save it in gmsh with Mesh.SaveParametric = 0"
REASONS = {
    NO_NUMBER: "something in it that should be a number is none",
    r"Illegal data type '(.*?)'": "it has numbers of the type {}, which VTU does not have",
    r"Unknown XDMF version (.*?)\.(?!\d)": "it is XDMF {}; versions 2 and 3 are read",
    r"Unknown XDMF Format '(.*?)'": "its numbers have the format {}; HDF, XML and Binary are read",
    r"^ '(Version|Format|TopologyType|Name|Center)'$": "something in it lacks the attribute {}",
    "Only supports one grid": "it does not have one grid",
    r"Need mesh format in .*\(got (.*?)\)": "it is of gmsh {}; versions 2 and 4 are read",
    "parametric nodes": PARAMETRIC,
    "Incompatible cell data 'gmsh:physical'": "only some of its points, curves and surfaces are in a physical group; "
    "save it in gmsh with Mesh.SaveAll = 0, or with Mesh.MshFileVersion = 2.2",
}
"""What is wrong with a file, by what numpy and meshio say of it."""
CUT = [errors.codes[code] for code in (errors.XML_ERROR_NO_ELEMENTS, errors.XML_ERROR_UNCLOSED_TOKEN)]
"""What expat finds where a file ends too soon."""
OTHERS = {"c": "complex numbers", **dict.fromkeys("SU", "text"), "O": "text or lists"}
"""What coordinates are that are no real numbers, by the kinds of numpy."""
COLUMNS = {"line": 2, "line3": 3, "triangle": 3, "triangle6": 6}
"""How many points the cells that are used have."""
MAX_SIZE = 2**28  # bytes of a mesh file
MAX_COUNT = 10_000_000  # points, cells and their numbers
SIZES = {
    ".msh": (rb"\$(?:Nodes|Elements|PhysicalNames|Entities|Periodic)\s+((?:\d+[ \t\r\n]+){1,4})",),
    ".vtu": (rb"NumberOf[A-Za-z]+\s*=\s*[\"']\s*(\d+)",),
    ".xdmf": (rb"(?:Dimensions|NumberOfElements)\s*=\s*[\"']([\d\s]+)",),
}
"""Where files say how much they hold, by their endings."""


def load(path: Path) -> Any:
    """The file as a meshio.Mesh; raises ValueError, naming the file, when it cannot be read."""
    import meshio  # here, because it is slow to import

    ending = path.suffix.lower()
    if ending not in FORMATS:
        raise ValueError(f"{EXPECTED}; got {path}")
    if not path.is_file():
        raise ValueError(f"{EXPECTED}; {path} is a folder" if path.is_dir() else f"{EXPECTED}; there is no file {path}")
    _check_sizes(path)
    if ending == ".xdmf" and (wrong := list(_wrong_numbers(path))):
        text = f"Input path of read must be a mesh file whose numbers can be read; of those that {path} names,"
        raise ValueError("\n  ".join([text, *wrong]))
    printed = io.StringIO()  # meshio prints its complaint and calls sys.exit
    try:
        with redirect_stdout(printed), redirect_stderr(printed), warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of numbers that fit no type, which are checked below
            warnings.filterwarnings("error", NO_NUMBER)  # which would end the array there
            mesh = meshio.read(path, FORMATS[ending])
    except (Exception, SystemExit) as error:
        said = "parametric nodes" if b"$ParametricNodes" in path.read_bytes() else printed.getvalue()
        raise ValueError(f"{EXPECTED}; {path} cannot be read as one: {_reason(error, said)}") from error
    if ending == ".vtu":
        mesh.field_data = {}  # such as the time; only gmsh has names of boundaries there
    _check_arrays(mesh, path)
    return mesh


def _reason(error: BaseException, printed: str) -> str:
    """Why a file cannot be read, in words of ours."""
    if isinstance(error, ElementTree.ParseError):
        line = error.position[0]
        return f"it ends too soon, in line {line}" if error.code in CUT else f"its line {line} is no XML"
    found = ((re.search(pattern, f"{printed} {error}"), reason) for pattern, reason in REASONS.items())
    return next((reason.format(*match.groups()) for match, reason in found if match), DAMAGED)


def _check_arrays(mesh: Any, path: Path) -> None:
    """Raise ValueError unless coordinates are real numbers and cells rows of whole ones: HDF5 can hold anything."""
    points = mesh.points
    if points.size and (points.dtype.kind not in "iuf" or points.ndim != 2 or points.shape[1] not in (2, 3)):
        shape = f"numbers in the shape {points.shape}" if points.dtype.kind in "iuf" else "no numbers"
        wanted = "Input path of read must be a mesh file whose coordinates are two or three real numbers a point"
        raise ValueError(f"{wanted}; those of {path} are {OTHERS.get(points.dtype.kind, shape)}")
    for block in mesh.cells:
        columns = COLUMNS.get(block.type)
        if columns and not _are_rows(block.data, columns):
            wanted = f"must be a mesh file whose {block.type} cells are rows of {columns} whole numbers"
            raise ValueError(f"Input path of read {wanted}; those of {path} are not")


def _are_rows(data: NDArray[Any], columns: int) -> bool:
    """Whether an array (n, columns) has whole numbers; those of XDMF are floats where it does not say what they are."""
    whole = data.dtype.kind in "iu" or (data.dtype.kind == "f" and bool((np.floor(data) == data).all()))
    return whole and data.ndim == 2 and data.shape[1] == columns and bool((np.abs(data) < 2**53).all())


def _check_sizes(path: Path) -> None:
    """Raise ValueError where a file says that it holds more than it can, before a reader makes room for that."""
    wrong = "Input path of read must be a mesh file"
    size = path.stat().st_size
    if not size:
        raise ValueError(f"{wrong}; {path} is empty")
    if size > MAX_SIZE:
        raise ValueError(f"{wrong} of at most {MAX_SIZE} bytes; {path} has {size}")
    data = path.read_bytes()
    for pattern in SIZES.get(path.suffix.lower(), ()):
        for match in re.finditer(pattern, data):
            for number in match[1].split():
                # A compressed file can be a thousand times smaller than its numbers.
                if len(number) > 18 or not 0 <= int(number) <= min(MAX_COUNT, 1000 * size):
                    count = number[:30].decode()
                    raise ValueError(
                        f"{wrong} with counts that fit its size; {path} states {count}, more than its {size} bytes hold"
                    )


def _wrong_numbers(path: Path) -> Iterator[str]:
    """Yield what is wrong with each file of numbers that an XDMF file names.

    A file that is not XML names none; meshio reports it.
    """
    try:
        items = list(ElementTree.parse(path).iter("DataItem"))
    except (ElementTree.ParseError, LookupError, ValueError, OSError):
        return
    named = {(item.get("Format"), (item.text or "").strip()) for item in items if "Reference" not in item.attrib}
    # As meshio finds them: HDF5 beside the mesh, raw numbers from the folder in which the program runs.
    datasets: dict[Path, set[str]] = {}
    for form, text in named:
        if form == "HDF":
            file, _, name = text.partition(":")
            datasets.setdefault(path.resolve().parent / file, set()).add(name.removeprefix("/"))
    for hdf5, names in sorted(datasets.items()):
        yield from _wrong_file(hdf5, sorted(names))
    for raw in sorted({Path(text) for form, text in named if form == "Binary"}):
        yield from _wrong_file(raw, None)


def _wrong_file(path: Path, datasets: list[str] | None) -> Iterator[str]:
    """Yield what is wrong with a file of raw numbers, or one of HDF5 that shall have some datasets."""
    from common import DEADLY, UNREADABLE, check_hdf5, lacking, survives  # here, because h5py is slow to import

    try:
        if not path.is_file():
            yield f"{path} is a folder, a pipe or a device, not a file" if path.exists() else f"{path} is missing"
        elif (size := path.stat().st_size) > MAX_SIZE:
            yield f"{path} has {size} bytes; at most {MAX_SIZE} are read"
        elif datasets is not None and not survives(path):
            yield f"{path} is damaged: {DEADLY}"
        elif datasets is not None:
            check_hdf5(path)
            for name in lacking(path, datasets):
                yield f"{path} has no data set {name}" if name else f"{path} is named without a data set after a colon"
    except ValueError as error:
        yield f"{path} is refused: {error}"
    except UNREADABLE:
        yield f"{path} is no HDF5 file, or is damaged"


def line_names(mesh: Any) -> list[set[str]]:
    """The names of each line of the file, in file order: its physical curves, or else its number."""
    blocks = [k for k, block in enumerate(mesh.cells) if block.type in ("line", "line3")]
    names: list[set[str]] = []
    for k in blocks:
        own: list[set[str]] = [set() for _ in mesh.cells[k].data]
        for name, rows in mesh.cell_sets.items():
            for row in rows[k].astype(int) if not name.startswith("gmsh:") else ():
                own[row].add(name)
        names += own
    key = _number_key(mesh.cell_data)
    if key is not None:
        curves = {int(tag): name for name, (tag, dimension) in mesh.field_data.items() if dimension == 1}
        tags = [int(tag) for k in blocks for tag in np.ravel(mesh.cell_data[key][k])]
        for own_names, tag in zip(names, tags, strict=True):
            if not own_names and not (tag == 0 and key == "gmsh:physical"):  # gmsh's 0 means no physical curve
                own_names.add(curves.get(tag, str(tag)))
    return names


def _number_key(data: dict[str, Any]) -> str | None:
    """The cell data that number boundaries: gmsh's, those called "boundary", or the only integers."""
    integers = [name for name, parts in data.items() if all(p.dtype.kind in "iu" and p.size == len(p) for p in parts)]
    for name in ("gmsh:physical", "boundary"):
        if name in integers:
            return name
    return integers[0] if len(integers) == 1 else None
