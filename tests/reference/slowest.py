"""Processor time of tests: the budget of `make test`, and tables of the tests and files that take the most.

Processor time, of the test's process and of those that it started, says more than the clock where tests run side by
side. What a fixture of a module takes counts for its file; compiled kernels and fixtures of the session are `aside`.
"""

from __future__ import annotations

import os
import re
import time
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import pytest
from numba.core import event

TEST, FILE = 2.0, 8.0  # s, that a test and a file may take if they are not marked slow
TURNS = 2_000_000
TURNING = 0.04  # s, for a loop of so many turns on the processor that these seconds are of
KEY = "processor time"
HEAD = """\
# The slowest tests

Processor seconds of setup, call and teardown, and their share of the {total:.0f} s of all {number} tests. Compiled
kernels and results that all tests share took {aside:.0f} s more. CONTRIBUTING has the command that writes these tables.

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
    parser.addoption("--budget", action="store_true", help="fail tests and files that take too much processor time")


class Aside(event.Listener):
    """A context whose processor time counts for no test: the compilation of kernels, and what all tests share."""

    def __init__(self) -> None:
        self.depth, self.began, self.total = 0, 0.0, 0.0

    def __enter__(self) -> None:
        if self.depth == 0:
            self.began = clock()
        self.depth += 1

    def __exit__(self, *_: object) -> None:
        self.depth -= 1
        if self.depth == 0:
            self.total += clock() - self.began

    def on_start(self, _: event.Event) -> None:
        self.__enter__()

    def on_end(self, _: event.Event) -> None:
        self.__exit__()


aside = Aside()
event.register("numba:compile", aside)


class Stopwatch:
    """Adds to each report the processor time of its phase; the controlling process sums them and writes the tables."""

    def __init__(self, config: pytest.Config):
        self.config = config
        self.last = spent()
        self.test = 0.0  # s, of the running test alone
        self.module = 0.0  # s, of the fixtures of modules that are made for it
        self.aside = 0.0
        self.files: Counter[str] = Counter()  # s, of tests not marked slow
        self.seconds: Counter[str] = Counter()

    def pytest_runtest_logstart(self) -> None:
        self.last, self.test = spent(), 0.0

    @pytest.hookimpl(wrapper=True)
    def pytest_fixture_setup(self, fixturedef: pytest.FixtureDef) -> Iterator[None]:
        began, before = spent(), self.module
        if fixturedef.scope == "session":
            with aside:
                return (yield)
        result = yield
        if fixturedef.scope != "function":
            self.module = before + spent() - began
        return result

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_makereport(self, item: pytest.Item):
        report = yield
        now = spent()
        took, self.last = now - self.last, now
        report.user_properties += [(KEY, took), ("aside", aside.total - self.aside)]
        self.test += took - self.module
        self.module, self.aside = 0.0, aside.total
        if self.config.getoption("budget") and "slow" not in item.keywords:
            self.spend(report, took)
        return report

    def spend(self, report: pytest.TestReport, took: float) -> None:
        """Fails a test that takes more than its budget, or with which the file takes more."""
        file = report.nodeid.split("::")[0]
        before = self.files[file]
        self.files[file] += took
        if report.when != "call" or not report.passed:
            return
        if self.test > TEST and self.test > TEST * pace():
            fail(report, f"{report.nodeid} took {self.test:.1f} s", f"a test may take {TEST:g} s: make it smaller")
        elif before <= FILE < self.files[file] and self.files[file] > FILE * pace():
            took, advice = f"{file} took {self.files[file]:.1f} s", "make results once in a fixture, or tests smaller"
            fail(report, took, f"a file may take {FILE:g} s: {advice}")

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        properties = dict(report.user_properties)
        self.seconds[report.nodeid] += properties.get(KEY, 0.0)
        self.seconds[""] += properties.get("aside", 0.0)

    def pytest_sessionfinish(self) -> None:
        if self.config.getoption("slowest") and not hasattr(self.config, "workerinput"):
            rows = tables(self.seconds, self.config.getoption("slowest_count"))
            self.config.getoption("slowest").write_text(rows, encoding="utf-8")


def fail(report: pytest.TestReport, took: str, bound: str) -> None:
    report.outcome = "failed"
    report.longrepr = f"{took} of processor time, and {bound}, or mark what is long `slow`, for `make test-all`"


def seconds_by_file(path: Path) -> Counter[str]:
    """Processor time of the files in such tables; nothing if there are none."""
    text = path.read_text(encoding="utf-8") if path.exists() else ""
    rows = re.findall(r"^\| ([\d.]+) \|.*`([^`:]*)` \|$", text, re.MULTILINE)
    return Counter({file: float(time) for time, file in rows})


def clock() -> float:
    """Processor time [s] of this process and of its children that have ended."""
    return sum(os.times()[:4])


def spent() -> float:
    """The same without what is aside."""
    return (aside.began if aside.depth else clock()) - aside.total


def pace() -> float:
    """How often slower this processor is at the moment than the one that the budget is for; at least 1."""
    began, total = time.process_time(), 0
    for turn in range(TURNS):
        total += turn
    return max(1.0, (time.process_time() - began) / TURNING)


def tables(seconds: Counter[str], count: int) -> str:
    shared = seconds.pop("", 0.0)
    total, files = seconds.total(), Counter[str]()
    for test, took in seconds.items():
        files[test.split("::")[0]] += took

    def rows(of: Counter[str]) -> str:
        return "".join(f"| {took:.1f} | {took / total:.1%} | `{name}` |\n" for name, took in of.most_common(count))

    return HEAD.format(total=total, number=len(seconds), aside=shared) + rows(seconds) + FILES + rows(files)
