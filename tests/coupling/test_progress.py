"""Bars that read what is being done at a point that knows none of them."""

import io
import sys

import pytest

from coupling.progress import CountBar, StageBar, doing


@pytest.fixture
def terminal(monkeypatch):
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)


def test_a_bar_of_stages_reads_what_is_being_done(terminal):
    with StageBar(2) as progress:
        (task,) = progress.__self__._bar.tasks
        with progress("Solving"):
            doing("stretching plate: 1 full solution, error 3e-2", 0.0)
            assert task.description == "stretching plate: 1 full solution, error 3e-2"
        assert task.completed == 1
    doing("nobody hears this", 1.0)
    assert "nobody" not in task.description


def test_a_count_begins_after_what_is_done_before_it(terminal):
    with CountBar("paths") as tell:
        (task,) = tell.__self__._bar.tasks
        doing("stretching plate: 7 full solutions, error 2e-4", 0.4)
        assert (task.description, task.completed, task.total) == (
            "stretching plate: 7 full solutions, error 2e-4",
            40,
            100,
        )
        tell(3, 20)
        assert (task.completed, task.total) == (3, 20)
        doing("stretching plate: 8 full solutions, error 1e-4", 0.5)
        assert (task.completed, task.total) == (3, 20) and task.description.startswith("stretching")


def test_nothing_is_printed_where_there_is_no_terminal(monkeypatch):
    errors = io.StringIO()
    monkeypatch.setattr(sys, "stderr", errors)
    with CountBar("paths"):
        doing("stretching plate: 7 full solutions, error 2e-4", 0.4)
    assert not errors.getvalue()
