"""The integrator and its moving surface against other ways to find the same path, at equal error of the end point.

    .venv/bin/python benchmarks/paths.py                    writes tables for benchmarks/RESULTS.md
    .venv/bin/python benchmarks/paths.py --counts 1 25      other numbers of actuators, up to 10 000; writes nothing
    .venv/bin/python benchmarks/paths.py --many             1 000 paths of 20 ms over 25 actuators

All methods must first agree on the path; then they are timed in turns, at errors of 1e-3, 1e-6 and 1e-9 of its length.
"""

from __future__ import annotations

import argparse

import report
from rivals import many
from rivals.compare import Comparison, ratios_table, work_table
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
    with threadpool_limits(1):  # of BLAS
        if asked.many:
            blocks["many paths"] = many.table()
        else:
            rows = []
            for problem in problems(asked.counts or COUNTS):
                rows += Comparison(problem).rows()
                print(f"{problem.name} done", flush=True)
            blocks["paths"], blocks["paths work"] = ratios_table(rows), work_table(rows)
    for name, lines in blocks.items():
        print("\n".join(lines), end="\n\n")
        if asked.counts is None:
            report.write(name, lines)


if __name__ == "__main__":
    main()
