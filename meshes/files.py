"""What meshio finds in a mesh file."""

from __future__ import annotations

import io
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path
from typing import Any

import numpy as np


def load(path: Path) -> Any:
    """The file as a meshio.Mesh; raises ValueError, naming the file, when it cannot be read."""
    import meshio  # slow to load, and only files need it

    if not path.is_file():
        raise ValueError(f"Input path of read must be a mesh file; there is no {path}")
    said = io.StringIO()  # meshio prints what it cannot read and leaves the interpreter
    try:
        with redirect_stdout(said), redirect_stderr(said):
            return meshio.read(path)
    except (Exception, SystemExit) as error:
        text = "" if isinstance(error, SystemExit) else f"{type(error).__name__}: {error}"
        reason = " ".join(f"{said.getvalue()} {text}".split())
        raise ValueError(
            f"Input path of read must be a .msh, .vtu or first-order .xdmf file; {path} cannot be read as one: {reason}"
        ) from error


def line_names(mesh: Any) -> list[str]:
    """The name of each line of the file, in its order; empty where it has none."""
    blocks = [k for k, block in enumerate(mesh.cells) if block.type in ("line", "line3")]
    named = {int(tag): name for name, (tag, dimension) in mesh.field_data.items() if dimension == 1}
    sets = {name: parts for name, parts in mesh.cell_sets.items() if not name.startswith("gmsh:")}
    integers = [name for name, parts in mesh.cell_data.items() if all(np.asarray(p).dtype.kind in "iu" for p in parts)]
    key = next((name for name in ("gmsh:physical", "boundary") if name in integers), None)
    if key is None and sets:
        names: list[str] = []
        for k in blocks:
            own = [""] * len(mesh.cells[k].data)
            for name, parts in sets.items():
                for row in np.asarray(parts[k], dtype=np.int64) if parts[k] is not None else ():
                    own[row] = name
            names += own
        return names
    if key is None and len(integers) == 1:
        key = integers[0]
    if key is None:
        return [""] * sum(len(mesh.cells[k].data) for k in blocks)
    tags = [int(tag) for k in blocks for tag in np.asarray(mesh.cell_data[key][k])]
    return ["" if tag == 0 and key == "gmsh:physical" else named.get(tag, str(tag)) for tag in tags]
