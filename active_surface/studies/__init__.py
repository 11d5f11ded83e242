"""Studies: sweeps of thousands of paths over the fields of a case, and drifts over the plate."""

import lazy_loader

__getattr__, __dir__, _ = lazy_loader.attach_stub(__name__, __file__)

__all__ = [  # public; the stub beside has also what other packages of the program use
    "Basin",
    "Basins",
    "Drift",
    "DriftMap",
    "Study",
    "Sweep",
    "drift",
    "read_study",
    "run_study",
]
