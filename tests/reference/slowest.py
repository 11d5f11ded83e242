"""The pytest option `--slowest=FILE`: Markdown tables of the tests and files that take the most processor time.

Processor time, of the test's process and of those that it started, says more than the clock where tests run side by
side. What a shared fixture takes counts for the first test that uses it.
"""

from __future__ import annotations

import os
import re
from collections import Counter
from pathlib import Path

import pytest

KEY = "processor time"
HEAD = """\
# The slowest tests

Processor seconds of setup, call and teardown, and their share of the {total:.0f} s of all {number} tests. The first
test that uses a shared fixture pays for it. CONTRIBUTING has the command that writes these tables.

| processor time, s | share | test |
|---:|---:|---|
"""
FILES = """
In this order files are started:

| processor time, s | share | file |
|---:|---:|---|
"""


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--slowest", type=Path, metavar="FILE", help="write tables of the slowest tests to FILE")
    parser.addoption("--slowest-count", type=int, default=50, metavar="N", help="rows of each table [50]")


class Stopwatch:
    """Adds to each report the processor time of its phase; the controlling process sums them and writes the tables."""

    def __init__(self, config: pytest.Config):
        self.config = config
        self.last = spent()
        self.seconds: Counter[str] = Counter()

    def pytest_runtest_logstart(self) -> None:
        self.last = spent()

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_makereport(self):
        report = yield
        now = spent()
        report.user_properties.append((KEY, now - self.last))
        self.last = now
        return report

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        self.seconds[report.nodeid] += dict(report.user_properties).get(KEY, 0.0)

    def pytest_sessionfinish(self) -> None:
        if not hasattr(self.config, "workerinput"):
            rows = tables(self.seconds, self.config.getoption("slowest_count"))
            self.config.getoption("slowest").write_text(rows, encoding="utf-8")


def seconds_by_file(path: Path) -> Counter[str]:
    """Processor time of the files in such tables; nothing if there are none."""
    text = path.read_text(encoding="utf-8") if path.exists() else ""
    rows = re.findall(r"^\| ([\d.]+) \|.*`([^`:]*)` \|$", text, re.MULTILINE)
    return Counter({file: float(time) for time, file in rows})


def spent() -> float:
    """Processor time [s] of this process and of its children that have ended."""
    return sum(os.times()[:4])


def tables(seconds: Counter[str], count: int) -> str:
    total, files = seconds.total(), Counter[str]()
    for test, time in seconds.items():
        files[test.split("::")[0]] += time

    def rows(of: Counter[str]) -> str:
        return "".join(f"| {time:.1f} | {time / total:.1%} | `{name}` |\n" for name, time in of.most_common(count))

    return HEAD.format(total=total, number=len(seconds)) + rows(seconds) + FILES + rows(files)
