"""What the first and a later run of the main job cost, over importing the libraries that it needs.

    .venv/bin/python benchmarks/starting.py       writes a table for benchmarks/RESULTS.md

Processor time of whole commands, on all threads. A first run and a later one must state the same figures. Then imports
and later runs take turns.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from resource import RUSAGE_CHILDREN, getrusage
from statistics import median
from typing import Any

import report

CASE = Path(__file__).parents[1] / "examples/transport.toml"
IMPORTS = "import numpy, scipy.sparse.linalg, numba, h5py, matplotlib.pyplot"
TURNS = 5


def cost(cache: Path, *arguments: str) -> tuple[float, str]:
    """Processor time [s] of Python with the kernels and plates of a folder, and what it printed."""

    def spent() -> float:
        used = getrusage(RUSAGE_CHILDREN)
        return used.ru_utime + used.ru_stime

    before = spent()
    environment = os.environ | {"NUMBA_CACHE_DIR": str(cache), "ACTIVE_SURFACE_CACHE": str(cache / "plates")}
    environment.pop("PYTHONDONTWRITEBYTECODE", None)  # a later run finds its sources compiled
    done = subprocess.run([sys.executable, *arguments], env=environment, stdout=subprocess.PIPE, text=True, check=True)
    return spent() - before, done.stdout


def run(cache: Path, folder: Path) -> tuple[float, dict[str, Any]]:
    """Processor time [s] of the main job, and its figures."""
    time, printed = cost(cache, "-m", "active_surface", "run", str(CASE), "--json", "--quiet", "--output", str(folder))
    return time, json.loads(printed)


def main() -> None:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        kernels = folder / "kernels"
        first, figures = run(kernels, folder)
        _, again = run(kernels, folder)
        assert all(figures[key] == again[key] for key in ("distance", "end_position", "outcome")), (figures, again)
        turns = [(cost(folder, "-c", IMPORTS)[0], run(kernels, folder)[0]) for _ in range(TURNS)]
    ratios = sorted(later / imports for imports, later in turns)
    lines = ["| run of the main job | processor time over imports |", "|---|---:|"]
    ratio = first / median(imports for imports, _ in turns)
    lines.append(f"| first: kernels compiled, the plate's model made | {ratio:.0f} |")
    lines.append(f"| later | {median(ratios):.1f} ({ratios[0]:.1f} - {ratios[-1]:.1f}) |")
    print("\n".join(lines))
    report.write("starting", lines)


if __name__ == "__main__":
    main()
