"""The coupling: case files, runs that join plate, part and friction, and their results."""

import lazy_loader

from coupling.environment import refuse_shadows

refuse_shadows("common", "meshes", "fem_plate", "particle")

__getattr__, __dir__, _ = lazy_loader.attach_stub(__name__, __file__)

__all__ = [  # public; the stub beside has also what other packages of the program use
    "Case",
    "CaseError",
    "Comparison",
    "InputError",
    "PartsResult",
    "Result",
    "SavedRun",
    "build_surface",
    "compare",
    "read_case",
    "read_parts",
    "read_run",
    "read_surface",
    "run_case",
    "run_cases",
    "run_parts",
    "surface_motion",
    "write_csv",
    "write_surface",
]
