"""Versions of the packages that compute a path."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from functools import cache
from importlib.metadata import version
from pathlib import Path

OURS = "active-surface"
OTHERS = ("numpy", "scipy", "numba")
PACKAGES = ("meshes", "fem_plate", "particle", "coupling")


def versions(packages: Sequence[str] = PACKAGES) -> dict[str, str]:
    """The versions of what computes a path; that of active-surface has a hash of the sources of these packages."""
    numbers = {name: version(name) for name in (OURS, *OTHERS)}
    return numbers | {OURS: f"{numbers[OURS]}+{_sources(tuple(packages))}"}


@cache
def _sources(packages: tuple[str, ...]) -> str:
    root, digest = Path(__file__).parents[1], hashlib.sha256()
    for file in sorted(file for package in packages for file in (root / package).rglob("*.py")):
        if "pictures" in (file.parent.name, file.stem):  # which no path depends on
            continue
        digest.update(f"{file.relative_to(root).as_posix()}\n".encode() + file.read_bytes())
    return digest.hexdigest()[:12]
