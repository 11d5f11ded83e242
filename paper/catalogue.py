"""The catalogue: which module reproduces which figure."""

from __future__ import annotations

import difflib
from collections.abc import Callable, Sequence
from importlib import import_module
from typing import Final

from paper.found import Found
from paper.models import Bench
from paper.parameters import Effort

MODULES: Final[dict[str, tuple[str, ...]]] = {
    "friction_logic": ("fig3", "fig4"),
    "feasible_area": ("fig5", "fig6"),
    "radial": ("fig11", "fig12"),
    "deceleration": ("fig13", "fig14"),
    "translocation": ("fig15",),
    "neighbours": ("fig16",),
    "convergence": ("fig17", "fig19"),
    "threshold": ("fig18",),
    "handover": ("fig20", "fig21"),
    "accuracy": ("fig22",),
    "dead_zones": ("deadzones",),
}
"""Names of figures by module, in the order of the page; kept here so that the command's help needs no solver."""
ALL: Final = "all"

Finder = Callable[[Bench, Effort], Found]


def modules_of(names: Sequence[str]) -> list[str]:
    """The modules of figures by name, each once, in the order of the catalogue; "all" or nothing: every one.

    Raises ValueError, naming every name that there is no figure of.
    """
    known = [name for own in MODULES.values() for name in own]
    wanted = {name.lower() for name in names} or {ALL}
    wrong = []
    for name in sorted(wanted - {*known, ALL}):
        near = difflib.get_close_matches(name, known, 1)
        wrong.append(f'"{name}"' + (f' (did you mean "{near[0]}"?)' if near else ""))
    if wrong:
        raise ValueError(f"Figures must be among {', '.join(known)} or all; got {', '.join(wrong)}")
    return [module for module, own in MODULES.items() if ALL in wanted or wanted & set(own)]


def finder(module: str) -> Finder:
    """What reproduces the figures of a module."""
    return import_module(f"paper.{module}").find  # type: ignore[no-any-return]
