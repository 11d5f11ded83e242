"""A run that is killed while it writes leaves files that open, with all steps that were flushed."""

import pytest
from kills import kills


@pytest.mark.slow
@pytest.mark.compiled
def test_killed_runs_leave_files_that_vtk_reads():
    for kill in kills(3, frames=400):
        assert all(kill.found[kind] >= steps for kind, steps in kill.flushed.items() if steps)
        assert any(kill.flushed.values())
