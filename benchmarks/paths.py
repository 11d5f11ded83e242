"""The integrator and its moving surface against other ways to find the same path, at equal error of the end point.

    .venv/bin/python benchmarks/paths.py                    writes tables and a picture for docs/benchmarks.md
    .venv/bin/python benchmarks/paths.py --counts 1 25      other numbers of actuators, up to 10 000; writes nothing
    .venv/bin/python benchmarks/paths.py --many             1 000 paths of 20 ms over 25 actuators

All methods must first agree on the path; then they are timed in turns, at errors of 1e-3, 1e-6 and 1e-9 of its length.
Where JAX is not installed it compares without, and leaves the page as it is.
"""

from __future__ import annotations

import argparse
from importlib.util import find_spec

import report
from rivals import many, neighbours, tables
from rivals.compare import Comparison
from rivals.problem import COUNTS, MOST, problems
from threadpoolctl import threadpool_limits


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--counts", type=int, nargs="+", metavar="N", help=f"numbers of actuators, 1 to {MOST}")
    parser.add_argument("--many", action="store_true", help="1 000 paths instead")
    asked = parser.parse_args()
    wrong = [count for count in asked.counts or [] if not 1 <= count <= MOST]
    if wrong:
        parser.error(f"--counts must be from 1 to {MOST}, up to which all forces fit in memory; got {wrong}")
    blocks: dict[str, list[str]] = {}
    writes = asked.counts is None
    with threadpool_limits(1):  # of BLAS
        if asked.many:
            blocks["many paths"] = many.table()
        else:
            rows = []
            for problem in problems(asked.counts or COUNTS):
                rows += Comparison(problem).rows()
                print(f"{problem.name} done", flush=True)
            blocks["paths"], blocks["paths work"] = tables.ratios_table(rows), tables.work_table(rows)
            blocks["paths neighbours"] = neighbours.table([n for n in asked.counts or COUNTS if n >= neighbours.FEWEST])
            if find_spec("jax") is None:
                print("JAX is not installed: compared without it, and docs/benchmarks.md left as it is.\n")
                writes = False
            if writes:
                tables.draw(rows)
    for name, lines in blocks.items():
        print("\n".join(lines), end="\n\n")
        if writes:
            report.write(name, lines)


if __name__ == "__main__":
    main()
