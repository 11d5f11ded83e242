"""Studies: sweeps of thousands of paths over the fields of a case.

Names are loaded when they are first used, so that `active-surface --help` does not wait for the solvers.
"""

from coupling.lazy import lazy

_HOMES = {
    "Study": "studies.study",
    "read_study": "studies.read",
    "Sweep": "studies.run",
    "run_study": "studies.run",
}

__all__ = list(_HOMES)  # noqa: PLE0605

__getattr__, __dir__ = lazy(__name__, _HOMES)
