"""Other files: what a file is that somebody took for a case, a study or an aim, and what to do with it."""

from __future__ import annotations

from pathlib import Path
from typing import Final

_HDF5: Final = b"\x89HDF\r\n\x1a\n"
_ZIP: Final = b"PK\x03\x04"
_RUN: Final = "a result of `active-surface run`; `active-surface view {file}` shows it, and `rerun` runs its case again"
_MESH: Final = 'a mesh; a case names it, mesh = "{name}" in [plate], in place of a shape'
_PICTURE: Final = "a picture; `active-surface run` takes the case that it was made from"
_TEXT: Final = "no TOML; `active-surface schema --template` writes a case to begin with"
_BY_ENDING: Final = {
    ".vtkhdf": _RUN,
    ".surface.h5": "the moving surface of a run; `read_surface` in Python reads it",
    ".nc": "a sweep, a map or a response, as a command left it; `active-surface view {file}` shows a sweep",
    ".h5": "an HDF5 file; results to show are NAME.plate.vtkhdf and NAME.part.vtkhdf",
    ".csv": 'a table of numbers; a case names it, file = "{name}" in [friction] or motion = "{name}" in [plate]',
    **dict.fromkeys((".msh", ".vtu", ".xdmf"), _MESH),
    **dict.fromkeys(
        (".stl", ".vtk", ".inp", ".step"), "no mesh that is read; a case takes .msh of gmsh, .vtu and .xdmf"
    ),
    ".geo": "a geometry of gmsh; `gmsh -2 {file}` makes the mesh that a case names",
    **dict.fromkeys((".png", ".pdf", ".svg", ".jpg", ".html", ".mp4", ".gif", ".webm"), _PICTURE),
    **dict.fromkeys((".yaml", ".yml", ".json", ".ini", ".cfg", ".md"), _TEXT),
    ".py": "a program in Python; `python {file}` runs it",
    ".ipynb": "a notebook; `jupyter lab {file}` opens it",
}
"""What files are, by how their names end."""


def what_else(path: Path, data: bytes) -> str:
    """What is wrong with a file that is no TOML, which says what it is; "" where it may be one."""
    kind = next((kind for ending, kind in _BY_ENDING.items() if path.name.lower().endswith(ending)), "")
    if not kind and data.startswith(_HDF5):
        kind = _BY_ENDING[".h5"]
    if not kind and (data.startswith(_ZIP) or b"\0" in data[:1000]) and not data.startswith((b"\xff\xfe", b"\xfe\xff")):
        kind = "no text"
    if kind:
        return f"is {kind}".format(file=path, name=path.name)
    if not data.strip():
        return f"is empty; `active-surface schema --template > {path}` writes a case that has every field"
    return ""


def folder_text(path: Path) -> str:
    """What is wrong with a folder, which names a file in it that may be meant."""
    files = sorted(path.glob("*.toml"))
    return "is a folder" + (f"; name a file in it, such as {files[0]}" if files else "")
