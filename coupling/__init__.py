"""The coupling: case files, runs that join plate, part and friction, and their results.

Names are loaded when they are first used, so that `active-surface --help` does not wait for the solvers.
"""

from coupling.lazy import lazy

_HOMES = {
    "Case": "coupling.case",
    "CaseError": "coupling.case",
    "read_case": "coupling.case",
    "Result": "coupling.run",
    "run_case": "coupling.run",
    "build_surface": "coupling.run",
    "write_csv": "coupling.csv_file",
    "SavedRun": "coupling.saved",
    "read_run": "coupling.saved",
    "surface_motion": "coupling.surface",
    "write_surface": "coupling.surface_file",
    "read_surface": "coupling.surface_file",
}

__all__ = list(_HOMES)  # noqa: PLE0605

__getattr__, __dir__ = lazy(__name__, _HOMES)
