"""Steering: the drives that bring a part to a target, or over way-points.

Names are loaded when they are first used, so that `active-surface --help` does not wait for the solvers.
"""

from importlib import import_module
from typing import Any

_HOMES = {
    "Settings": "steering.tables",
    "Task": "steering.task",
    "read_task": "steering.read",
    "Aimed": "steering.aimed",
    "aim": "steering.aiming",
    "Route": "steering.route",
    "read_route": "steering.read",
    "Planned": "steering.planned",
    "plan": "steering.planning",
}

__all__ = list(_HOMES)  # noqa: PLE0605


def __dir__() -> list[str]:
    return sorted([*globals(), *_HOMES])


def __getattr__(name: str) -> Any:
    if name in _HOMES:
        return getattr(import_module(_HOMES[name]), name)
    raise AttributeError(f"module 'steering' has no attribute {name!r}")
