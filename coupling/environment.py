"""Versions: those of what a path is found by."""

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
    """The versions of what a path is found by; that of active-surface has a hash of these of its packages' sources."""
    found = {name: version(name) for name in (OURS, *OTHERS)}
    return found | {OURS: f"{found[OURS]}+{_sources(tuple(packages))}"}


@cache
def _sources(packages: tuple[str, ...]) -> str:
    root, digest = Path(__file__).parents[1], hashlib.sha256()
    for file in sorted(file for package in packages for file in (root / package).rglob("*.py")):
        if "pictures" in (file.parent.name, file.stem):  # which no path depends on
            continue
        digest.update(f"{file.relative_to(root).as_posix()}\n".encode() + file.read_bytes())
    return digest.hexdigest()[:12]
