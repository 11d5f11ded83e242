"""What a face, a film of air and a sweep cost, over paths of a point, without a film and one by one.

    .venv/bin/python benchmarks/faces.py       writes a table for benchmarks/RESULTS.md

First a tiny face must end where a point does, thin air in a wide gap must leave a path as it is without a film, and a
sweep must have the ends of single runs to the bit. Then the ways take turns; the table has ratios within a turn.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from pathlib import Path
from statistics import median
from time import perf_counter
from typing import Any

import numpy as np
import report
from threadpoolctl import threadpool_limits

from active_surface import Case, SurfaceMotion, Trajectory, build_surface, read_case, run_case, run_study, simulate
from active_surface.studies import read_study
from coupling import build_friction, build_part

EXAMPLES = Path(__file__).parents[1] / "examples"
SMOOTH = {"friction.coefficient": 0.01, "run.tolerance": 1e-12}  # with which a point on the surface slips, too
TINY, LIMIT = 1e-9, 1e-6  # m, a side; of the way, that the ends may be apart
SIDE, DURATION, AIR = 95e-6, 20e-3, {"pressure": "101325 Pa", "bow": "1 um"}  # m, s; of a point on a film
THIN, BOUND = {"pressure": "1 kPa", "bow": "3 um"}, 5e-3  # of the way, as docs/air.md states it
COUNT, FEW, SHORT = 1000, 4, 1e-3  # headings of the sweep, and of single runs; s
STUDY = """\
[study]
case = "face.toml"

[[axes]]
field = "part.heading"
range = ["0 deg", "180 deg"]
count = {count}
"""
ROUNDS, SWEEPS = 9, 3

Work = Callable[[], Any]


def path(case: Case, surface: SurfaceMotion) -> Callable[[], Trajectory]:
    """Follows the part of a case over a surface, when called."""
    part, friction, run = build_part(case), build_friction(case), case.run
    return lambda: simulate(surface, part, friction, run.duration, run.gravity, run.tolerance)


def point(case: Case, **fields: Any) -> Case:
    """The case with a point of the same mass in place of its part; fields: of [part], and `air`."""
    tables = {key: getattr(case, key) for key in ("plate", "actuators", "friction", "run")}
    air = {"air": fields.pop("air")} if "air" in fields else {}
    return Case(**tables, **air, part={"mass": case.part.mass, "position": case.part.position, **fields})


def apart(one: Trajectory, other: Trajectory) -> float:
    """How far ends are apart, over the way."""
    return float(np.hypot(*(one.position[-1] - other.position[-1]))) / other.path_length


def turns(first: Work, second: Work, rounds: int, count: int = 1) -> str:
    """The time of the first over that of so many calls of the second: median (least - most) of rounds, in turns."""
    ratios = []
    for _ in range(rounds):
        begin = perf_counter()
        first()
        middle = perf_counter()
        for _ in range(count):
            second()
        ratios.append((middle - begin) / (perf_counter() - middle))
    return f"{median(ratios):.2g} ({min(ratios):.2g} - {max(ratios):.2g})"


def face() -> tuple[str, str, str]:
    """A path of a face over that of a point, on a linear plate."""
    case = read_case(EXAMPLES / "face.toml").vary({"plate.theory": "linear"})
    surface, mass = build_surface(case), case.part.mass
    tiny = case.vary({"part.sides": [TINY, TINY], "part.thickness": TINY, "part.mass": mass, **SMOOTH})
    off = apart(path(tiny, surface)(), path(point(tiny, centre_height=TINY / 2), surface)())
    assert off < LIMIT, f"a tiny face ends {off:.1e} of its way from a point"
    centre = (case.part.thickness or 0.0) / 2
    ways = path(case, surface), path(point(case, centre_height=centre), surface)
    return "a face", "a point", f"{turns(*ways, ROUNDS)} | {off:.0e}"


def film() -> list[tuple[str, str, str]]:
    """A path on a film of air over that with drag alone, in a room's air and thin."""
    case, rows = read_case(EXAMPLES / "transport.toml").vary({"run.duration": DURATION}), []
    surface, square = build_surface(case), {"size": SIDE, "centre_height": SIDE / 2}
    for under, one in {"a film": point(case, **square, air=AIR), "a film under a face": case}.items():
        for name, air in {"thin air, wide": THIN, "a room's air, bowed": AIR}.items():
            ways = [path(one.vary({"air": {**air, "film": has}}), surface) for has in (True, False)]
            off = apart(ways[0](), ways[1]())
            assert off < BOUND or air is not THIN, f"a film of thin air moves the end by {off:.1e} of the way"
            rows.append((f"{under}, {name}", "drag alone", f"{turns(*ways, ROUNDS)} | {off:.0e}"))
    return rows


def sweep() -> tuple[str, str, str]:
    """A sweep over headings on one thread, over as many single paths on a surface that is there."""
    case = read_case(EXAMPLES / "face.toml").vary({"plate.theory": "linear", "run.duration": SHORT})
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "study.toml")
        file.write_text(STUDY.format(count=COUNT))
        study = read_study(file, case)
    found = run_study(study, threads=1).dataset
    for k in np.linspace(0, COUNT - 1, FEW).astype(int).tolist():
        single = run_case(case.vary({"part.heading": float(found["part.heading"][k])})).summary.end_position
        ends = float(found["end_x"][k]), float(found["end_y"][k])
        assert ends == single, f"the sweep ends at {ends}, a single run at {single}"
    many = turns(lambda: run_study(study, threads=1), path(case, build_surface(case)), SWEEPS, COUNT)
    return f"a sweep of {COUNT} headings", f"{COUNT} single paths", f"{many} | 0"


def main() -> None:
    lines = ["| | over | time | ends apart, of the way |", "|---|---|---:|---:|"]
    with threadpool_limits(1):
        for row in (face(), *film(), sweep()):
            lines.append("| " + " | ".join(row) + " |")
            print(lines[-1], flush=True)
    report.write("faces", lines)


if __name__ == "__main__":
    main()
