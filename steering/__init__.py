"""Steering: the drives that bring a part to a target, or over way-points.

Names are loaded when they are first used, so that `active-surface --help` does not wait for the solvers.
"""

from coupling.lazy import lazy

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

__getattr__, __dir__ = lazy(__name__, _HOMES)
