"""The paper, reproduced: one module for each of its figures or group of them, in three models side by side.

Names are loaded when they are first used.
"""

from coupling.lazy import lazy

_HOMES = {
    "PARAMETERS": "paper.parameters",
    "Parameters": "paper.parameters",
    "QUICK": "paper.parameters",
    "FULL": "paper.parameters",
    "Verdict": "paper.verdict",
    "reproduce": "paper.reproduction",
}

__all__ = list(_HOMES)  # noqa: PLE0605

__getattr__, __dir__ = lazy(__name__, _HOMES)
