"""The catalogue: which module reproduces which figure."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from importlib import import_module
from typing import Final

from active_surface.paper.figure_result import FigureResult
from active_surface.paper.models import Bench
from active_surface.paper.parameters import Effort
from coupling import near

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
DRAWINGS: Final = (1, 2, 7, 8, 9, 10)

Finder = Callable[[Bench, Effort], FigureResult]


def modules_of(names: Sequence[str]) -> list[str]:
    """The modules of figures by name, each once, in the order of the catalogue; "all" or nothing: every one.

    "fig17", "17", "17a" and "figure 17" are the same.
    Raises ValueError, naming every name that there is no figure of, as it was given.
    """
    known = [name for own in MODULES.values() for name in own]
    chosen, wrong = set(), []
    for text in names or [ALL]:
        number = re.fullmatch(r"(?:fig\.?|figure)?\s*(\d+)[ab]?", text.strip().lower())
        name = f"fig{int(number[1])}" if number else text.strip().lower()
        meant = near(name, known)
        if name in (*known, ALL):
            chosen.add(name)
        elif number and int(number[1]) in DRAWINGS:
            wrong.append(f'"{text}" (figures 1, 2 and 7 to 10 are drawings)')
        else:
            wrong.append(f'"{text}"' + (f' (did you mean "{meant}"?)' if meant else ""))
    if wrong:
        raise ValueError(f"Figures must be among {', '.join(known)} or all; got {', '.join(wrong)}")
    return [module for module, own in MODULES.items() if ALL in chosen or chosen & set(own)]


def finder(module: str) -> Finder:
    """What reproduces the figures of a module."""
    return import_module(f"active_surface.paper.figures.{module}").find  # type: ignore[no-any-return]
