"""Mesh files, as meshio reads them."""

from __future__ import annotations

import io
import re
import warnings
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path
from typing import Any

DAMAGED = "it is damaged, or its parts do not fit together"
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

    if not path.is_file():
        raise ValueError(f"Input path of read must be a mesh file; there is no {path}")
    _check_sizes(path)
    if path.suffix.lower() == ".xdmf":
        from meshes.xdmf import wrong_numbers  # here, because h5py is slow to import

        if wrong := list(wrong_numbers(path, MAX_SIZE)):
            text = f"Input path of read must be a mesh file whose numbers can be read; of those that {path} names,"
            raise ValueError("\n  ".join([text, *wrong]))
    printed = io.StringIO()  # meshio prints its complaint and calls sys.exit
    try:
        with redirect_stdout(printed), redirect_stderr(printed), warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of numbers that fit no type, which are checked below
            return meshio.read(path)
    except (Exception, SystemExit) as error:
        readable = isinstance(error, (meshio.ReadError, SyntaxError))  # a ParseError of XML is one
        text = f"{type(error).__name__}: {error}" if readable else DAMAGED
        text = "" if isinstance(error, SystemExit) else text
        reason = " ".join(re.sub(r"\x1b\[[\d;]*m", "", f"{printed.getvalue()} {text}").split())[:200]
        raise ValueError(
            f"Input path of read must be a .msh, .vtu or first-order .xdmf file; {path} cannot be read as one: {reason}"
        ) from error


def _check_sizes(path: Path) -> None:
    """Raise ValueError where a file says that it holds more than it can, before a reader makes room for that."""
    wrong = "Input path of read must be a mesh file"
    size = path.stat().st_size
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
        tags = [int(tag) for k in blocks for tag in mesh.cell_data[key][k]]
        for own_names, tag in zip(names, tags, strict=True):
            if not own_names and not (tag == 0 and key == "gmsh:physical"):  # gmsh's 0 means no physical curve
                own_names.add(curves.get(tag, str(tag)))
    return names


def _number_key(data: dict[str, Any]) -> str | None:
    """The cell data that number boundaries: gmsh's, those called "boundary", or the only integers."""
    integers = [name for name, parts in data.items() if all(part.dtype.kind in "iu" for part in parts)]
    for name in ("gmsh:physical", "boundary"):
        if name in integers:
            return name
    return integers[0] if len(integers) == 1 else None
