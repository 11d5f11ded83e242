"""Studies: sweeps of thousands of paths over the fields of a case.

Names are loaded when they are first used, so that `active-surface --help` does not wait for the solvers.
"""

from importlib import import_module
from typing import Any

_HOMES = {
    "Study": "studies.study",
    "read_study": "studies.read",
    "Sweep": "studies.run",
    "run_study": "studies.run",
}

__all__ = list(_HOMES)  # noqa: PLE0605


def __dir__() -> list[str]:
    return sorted([*globals(), *_HOMES])


def __getattr__(name: str) -> Any:
    if name in _HOMES:
        return getattr(import_module(_HOMES[name]), name)
    raise AttributeError(f"module 'studies' has no attribute {name!r}")
