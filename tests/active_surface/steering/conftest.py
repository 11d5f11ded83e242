"""The case of these tests: two actuators, and a part beside the middle of a disc."""

import pytest
from sweeps import PLATE, read_text

from coupling import build_surface


@pytest.fixture(scope="session")
def text():
    """A case file, whose part is brought to (-20 um, 20 um)."""
    return PLATE.replace('duration = "5 ms"', 'duration = "20 ms"').replace('["-140 um", "20 um"]', '["0 um", "40 um"]')


@pytest.fixture(scope="session")
def case(tmp_path_factory, text):
    return read_text(tmp_path_factory.mktemp("case"), text)


@pytest.fixture(scope="session")
def surface(case):
    return build_surface(case)


@pytest.fixture
def folder(tmp_path, text):
    """A folder with the case file base.toml."""
    (tmp_path / "base.toml").write_text(text)
    return tmp_path
