"""Runs of all tests but those marked `advice` end without looking for it, whose trial runs take ten times as long."""

import pytest

import coupling.summary
from coupling.advice import advise


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item: pytest.Item) -> None:
    coupling.summary.advise = advise if "advice" in item.keywords else lambda *_: None


@pytest.hookimpl(trylast=True)
def pytest_runtest_teardown() -> None:
    coupling.summary.advise = advise
