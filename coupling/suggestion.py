"""Suggest the known word, or the file, that a wrong one is most like."""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from pathlib import Path
from typing import Final

LIKE: Final = 0.65  # share of letters; less is another word

_ALIASES: Final = {
    "e": ["youngs_modulus"], "nu": ["poisson_ratio"], "\u03bd": ["poisson_ratio"], "rho": ["density"],
    "\u03c1": ["density"], "t": ["time", "thickness", "duration"], "h": ["thickness", "centre_height", "time_step"],
    "r": ["radius"], "d": ["radius"], "diameter": ["radius"], "a": ["semi_axis_x", "radius"], "b": ["semi_axis_y"],
    "n": ["sides", "points"], "zeta": ["damping"], "\u03b6": ["damping"], "q": ["damping"],
    "x": ["position"], "y": ["position"], "f": ["frequency", "limit"], "freq": ["frequency"],
    "period": ["frequency", "pitch"], "omega": ["frequency"], "\u03c9": ["frequency"], "amplitude": ["stroke"],
    "phi": ["phase"], "\u03c6": ["phase"], "k": ["stiffness"], "nx": ["columns"], "ny": ["rows"],
    "m": ["mass"], "weight": ["mass"], "v": ["velocity"], "mu": ["coefficient"], "\u03bc": ["coefficient"],
    "\u00b5": ["coefficient"], "sigma": ["roughness"], "psi": ["plasticity_index"], "gamma": ["adhesion_energy"],
    "t_end": ["duration"], "dt": ["time_step"], "g": ["gravity"], "tol": ["tolerance"],
    "circle": ["disc"], "square": ["rectangle"], "fixed": ["clamped"], "pinned": ["simply-supported"],
}  # fmt: skip
"""What the letters and words of textbooks stand for; the first known one is taken."""


def near(word: str, known: Iterable[str]) -> str | None:
    """The known word that another stands for, is the only one to begin with, or is most like; None: there is none."""
    there, given = {choice.lower(): choice for choice in known}, word.strip().lower()
    alias = next((meant for meant in _ALIASES.get(given, ()) if meant in there), None)
    begun = [choice for choice in there if len(given) > 2 and choice.startswith(given)]
    likely = alias or (
        begun[0] if len(begun) == 1 else next(iter(difflib.get_close_matches(given, there, 1, LIKE)), None)
    )
    return there[likely] if likely else None


def near_file(path: Path, ending: str = ".toml") -> Path | None:
    """The file with an ending that a path without a file is most like, in its own folder or one with a like name."""
    folder = path.parent
    if not folder.is_dir() and folder.parent.is_dir():
        names = [entry.name for entry in folder.parent.iterdir() if entry.is_dir()]
        folder = folder.parent / next(iter(difflib.get_close_matches(folder.name, names, 1)), folder.name)
    try:
        names = [entry.name for entry in folder.iterdir() if entry.name.endswith(ending) and entry.is_file()]
    except OSError:  # no folder, or one that may not be read
        return None
    name = path.name if path.name.endswith(ending) else path.name + ending
    likely = difflib.get_close_matches(name, names, 1, 0.75)
    return folder / likely[0] if likely else None
