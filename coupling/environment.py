"""The packages that compute a path: their versions, and that no module of a user hides them."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from functools import cache
from importlib.util import find_spec
from pathlib import Path

OURS = "active-surface"
OTHERS = ("numpy", "scipy", "numba")
PACKAGES = ("meshes", "fem_plate", "particle", "coupling")


def refuse_shadows(*packages: str) -> None:
    """Raise ImportError if Python would import one of these packages from anywhere but beside this one."""
    root = Path(__file__).resolve().parents[1]
    for name in packages:
        spec = find_spec(name)
        if spec and spec.origin and Path(spec.origin).resolve() != root / name / "__init__.py":
            module = Path(spec.origin).parent if spec.submodule_search_locations else spec.origin
            raise ImportError(f"{module} hides the package {name} of active-surface; rename it")


def versions(packages: Sequence[str] = PACKAGES) -> dict[str, str]:
    """The versions of what computes a path; that of active-surface has a hash of the sources of these packages."""
    numbers = _installed()
    return numbers | {OURS: f"{numbers[OURS]}+{_sources(tuple(packages))}"}


@cache
def _installed() -> dict[str, str]:
    from importlib.metadata import version  # here, because every command loads this module first

    return {name: version(name) for name in (OURS, *OTHERS)}


@cache
def _sources(packages: tuple[str, ...]) -> str:
    root, digest = Path(__file__).parents[1], hashlib.sha256()
    for file in sorted(file for package in packages for file in (root / package).rglob("*.py")):
        if "pictures" in (file.parent.name, file.stem):  # which no path depends on
            continue
        digest.update(f"{file.relative_to(root).as_posix()}\n".encode() + file.read_bytes())
    return digest.hexdigest()[:12]
