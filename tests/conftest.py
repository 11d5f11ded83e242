"""What all tests share: the paper's plate, two actuators off its centre, a run of each kind, the `compiled` marker."""

from __future__ import annotations

import ctypes
import gc
import signal
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from pathlib import Path

import numba
import numpy as np
import pytest
import shared_runs
import slowest
from hypothesis import settings

from coupling import Result
from fem_plate import PlateSection
from fem_plate.analytic import DiscShapes

RADIUS = 300e-6  # m
TABLE = Path(__file__).parent / "slowest.md"

# A shell starts what runs in the background deaf to Ctrl-C, and so would be the commands that tests interrupt.
if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)


# The same examples in every run: what fails, fails again.
settings.register_profile("same examples", derandomize=True, deadline=None)
settings.load_profile("same examples")

pytest_addoption = slowest.pytest_addoption


def pytest_configure(config: pytest.Config) -> None:
    if config.getoption("slowest") or config.getoption("budget"):
        config.pluginmanager.register(slowest.Stopwatch(config))


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    # Files that take long first, so that no process ends long after the others.
    seconds = slowest.seconds_by_file(TABLE)
    items.sort(key=lambda item: -seconds[item.nodeid.split("::")[0]])
    if numba.config.DISABLE_JIT:
        skip = pytest.mark.skip(reason="NUMBA_DISABLE_JIT is set: this march takes too long in plain Python")
        for item in items:
            if "compiled" in item.keywords:
                item.add_marker(skip)


@pytest.hookimpl(trylast=True)
def pytest_runtest_teardown(item: pytest.Item, nextitem: pytest.Item | None) -> None:
    # Processes run thousands of tests: what the C library keeps for the next request would come to gigabytes.
    if nextitem is None or nextitem.path != item.path:
        gc.collect()
        gc.freeze()  # what modules keep is not looked through again after each file: .5 s
        with suppress(OSError, AttributeError):  # glibc's
            ctypes.CDLL(None).malloc_trim(0)


@pytest.fixture(scope="session")
def radius() -> float:
    """Radius of the paper's plate [m]."""
    return RADIUS


@pytest.fixture(scope="session")
def section() -> PlateSection:
    """The paper's plate: silicon, 5 um thick."""
    return PlateSection(youngs_modulus=169e9, poisson_ratio=0.3, thickness=5e-6, density=2330)


@pytest.fixture(scope="session")
def layout() -> np.ndarray:
    """Two actuators off the centre and off every axis of symmetry [m]."""
    return np.array([[90e-6, 40e-6], [-60e-6, 120e-6]])


@pytest.fixture(scope="session")
def exact(layout: np.ndarray) -> DiscShapes:
    """The influence shapes of that layout in closed form."""
    return DiscShapes(layout, RADIUS)


@pytest.fixture(scope="session")
def spots(layout: np.ndarray) -> np.ndarray:
    """Points all over the plate, at least 0.02 radii away from the actuators [m]."""
    rng = np.random.default_rng(1)
    r, angle = RADIUS * np.sqrt(rng.uniform(0, 1, 2000)), rng.uniform(0, 2 * np.pi, 2000)
    xy = np.stack([r * np.cos(angle), r * np.sin(angle)], axis=1)
    return xy[np.linalg.norm(xy[:, None] - layout, axis=-1).min(axis=1) > 0.02 * RADIUS]


@pytest.fixture(scope="session")
def ran(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Result]:
    """The result of a run of each kind in `shared_runs`, made when first asked for, with files not to be changed."""

    @cache
    def run(kind: str) -> Result:
        with slowest.aside:
            return shared_runs.run(kind, tmp_path_factory.mktemp(kind))

    return run
