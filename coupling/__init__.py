"""The coupling: case files, runs that join plate, part and friction, and their results.

Names are loaded when they are first used, so that `active-surface --help` does not wait for the solvers.
"""

from importlib import import_module
from typing import Any

_HOMES = {
    "Case": "coupling.case",
    "CaseError": "coupling.case",
    "read_case": "coupling.case",
    "Result": "coupling.run",
    "run_case": "coupling.run",
    "build_surface": "coupling.run",
    "write_csv": "coupling.csv_file",
    "surface_motion": "coupling.surface",
    "write_surface": "coupling.surface_file",
    "read_surface": "coupling.surface_file",
}

__all__ = list(_HOMES)  # noqa: PLE0605


def __dir__() -> list[str]:
    return sorted([*globals(), *_HOMES])


def __getattr__(name: str) -> Any:
    if name in _HOMES:
        return getattr(import_module(_HOMES[name]), name)
    raise AttributeError(f"module 'coupling' has no attribute {name!r}")
