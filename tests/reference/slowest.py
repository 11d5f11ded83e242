"""Processor time of tests: those beyond the budget of `make test`, and tables of the slowest tests and files.

Processor time, of the test's process and of those that it started, says more than the clock where tests run side by
side. Compiled kernels and fixtures of the session are `aside`. The budget is a share of all tests' time, as seconds
depend on the processor and on what else it does; it is reported, and fails no test.
"""

from __future__ import annotations

import os
import re
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import pytest
from numba.core import event

TEST, FILE = 0.01, 0.04  # of the time of all tests, that a test and a file may take if they are not marked slow
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
    parser.addoption("--budget", action="store_true", help="name tests and files that take too much processor time")


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
        self.aside = 0.0
        self.seconds: Counter[str] = Counter()

    def pytest_runtest_logstart(self) -> None:
        self.last = spent()

    @pytest.hookimpl(wrapper=True)
    def pytest_fixture_setup(self, fixturedef: pytest.FixtureDef) -> Iterator[None]:
        if fixturedef.scope != "session":
            return (yield)
        with aside:
            return (yield)

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_makereport(self):
        report = yield
        now = spent()
        report.user_properties += [(KEY, now - self.last), ("aside", aside.total - self.aside)]
        self.last, self.aside = now, aside.total
        return report

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        properties = dict(report.user_properties)
        self.seconds[report.nodeid] += properties.get(KEY, 0.0)
        self.seconds[""] += properties.get("aside", 0.0)

    def pytest_terminal_summary(self, terminalreporter: pytest.TerminalReporter) -> None:
        if self.config.getoption("budget"):
            seconds = Counter(self.seconds)
            seconds.pop("", None)
            total, files = seconds.total(), by_file(seconds)
            for share, times in ((TEST, seconds), (FILE, files)):
                for name, took in times.most_common():
                    if took > share * total:
                        beyond = f"{took / total:.1%} of the processor time of all tests, {share:.0%} at most"
                        terminalreporter.write_line(f"beyond its budget: {name} took {beyond}")

    def pytest_sessionfinish(self) -> None:
        if self.config.getoption("slowest") and not hasattr(self.config, "workerinput"):
            rows = tables(self.seconds, self.config.getoption("slowest_count"))
            self.config.getoption("slowest").write_text(rows, encoding="utf-8")


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


def by_file(seconds: Counter[str]) -> Counter[str]:
    files = Counter[str]()
    for test, took in seconds.items():
        files[test.split("::")[0]] += took
    return files


def tables(seconds: Counter[str], count: int) -> str:
    shared = seconds.pop("", 0.0)
    total, files = seconds.total(), by_file(seconds)

    def rows(of: Counter[str]) -> str:
        return "".join(f"| {took:.1f} | {took / total:.1%} | `{name}` |\n" for name, took in of.most_common(count))

    return HEAD.format(total=total, number=len(seconds), aside=shared) + rows(seconds) + FILES + rows(files)
