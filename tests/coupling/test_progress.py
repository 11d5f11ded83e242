"""Bars that read what is being done at a point that knows none of them, and lines where there is no terminal."""

import io
import sys
import threading

import pytest

from coupling import build_scene, progress, stage_count
from coupling.progress import Bar, doing, silent
from particle import ConstantFriction, Micropart, path, platform_surface, simulate


@pytest.fixture
def terminal(monkeypatch):
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)


def test_a_bar_of_stages_reads_what_is_being_done(terminal):
    with Bar(2) as progress:
        task = progress.__self__.task
        with progress("Solving"):
            doing("stretching plate: 1 full solution, error 3e-2", 0.0)
            assert task.description == "stretching plate: 1 full solution, error 3e-2"
        assert task.completed == 1
    doing("nobody hears this", 1.0)
    assert "nobody" not in task.description


def test_a_count_begins_after_what_is_done_before_it(terminal):
    with Bar() as bar, bar("paths") as tell:
        task = tell.__self__.task
        doing("stretching plate: 7 full solutions, error 2e-4", 0.4)
        assert task.description == "stretching plate: 7 full solutions, error 2e-4, 40 %"
        tell(3, 20)
        assert (task.completed, task.total) == (3, 20)
        doing("stretching plate: 8 full solutions, error 1e-4", 0.5)
        assert (task.completed, task.total) == (3, 20) and task.description.startswith("stretching")


class Log(io.StringIO):
    """No terminal; says when there is a whole line."""

    def __init__(self):
        super().__init__()
        self.written = threading.Event()

    def flush(self):
        self.written.set()

    def next_line(self):
        """The line after the one that was perhaps being written."""
        for _ in range(2):
            self.written.clear()
            assert self.written.wait(10)
        return self.getvalue().splitlines()[-1]


def logged(monkeypatch):
    """The log, with many lines a second; not a fixture, as pytest puts its own error stream in place after these."""
    monkeypatch.setattr(sys, "stderr", Log())
    monkeypatch.setattr(progress, "PERIOD", 0.01)
    return sys.stderr


def test_without_a_terminal_lines_say_which_stages_are_done_and_left(monkeypatch):
    log = logged(monkeypatch)
    with Bar(3) as stages:
        with stages("Solving"):
            assert log.next_line() == "0:00:00  0 of 3 stages done; Solving"
        with stages("Following") as tell:
            tell(12, 40)
            assert log.next_line().endswith("  1 of 3 stages done; Following: 12 of 40")
            doing("stretching plate: 7 full solutions, error 2e-4", 0.4)
            assert log.next_line().endswith(
                "  1 of 3 stages done; stretching plate: 7 full solutions, error 2e-4, 40 %"
            )
    end = log.getvalue()
    log.written.clear()
    assert not log.written.wait(0.05) and log.getvalue() == end


@pytest.mark.parametrize(
    "kind", ["linear", pytest.param("vibrating", marks=pytest.mark.slow), "stretching", "platform"]
)
def test_a_run_has_as_many_stages_as_it_counts(ran, kind):
    stages = []
    build_scene(ran(kind).case, lambda stage: stages.append(stage) or silent(stage))
    assert len([*stages, "path", "validity", "files"]) == stage_count(ran(kind).case)


def test_without_a_terminal_lines_count_pieces_and_estimate_the_time_left(monkeypatch):
    log = logged(monkeypatch)
    now = [0.0]
    with Bar() as bar, bar("paths") as tell:
        monkeypatch.setattr(progress, "_now", lambda: now[0])
        assert log.next_line().endswith("  no paths yet")
        doing("stretching plate: 7 full solutions, error 2e-4", 0.4)
        assert log.next_line().endswith("  no paths yet; stretching plate: 7 full solutions, error 2e-4, 40 %")
        tell(100, 400)  # those done before
        now[0] = 60.0
        tell(120, 400)  # 20 a minute
        assert log.next_line().endswith("  120 of 400 paths, 0.33/s, about 0:14:00 left")
        tell(400, 400)
        assert log.next_line().endswith("  400 of 400 paths; writing all")


def test_without_a_terminal_lines_say_how_far_a_single_path_is(monkeypatch):
    log = logged(monkeypatch)
    lines, march = [], path.march

    def slow(*arguments):
        done = march(*arguments)
        lines.append(log.next_line())
        return done

    monkeypatch.setattr(path, "march", slow)
    inputs = platform_surface(size=1e-3), Micropart(2e-9, (0.0, 0.0)), ConstantFriction(2e-9), 0.04
    with Bar(2) as stages:
        with stages("Following the part"):
            simulate(*inputs)
        with stages("Following the parts") as tell:
            tell(3, 20)
            simulate(*inputs)
    assert lines[0].endswith("  0 of 2 stages done; Following the part; path at 40 of 40 ms")
    assert lines[1].endswith("  1 of 2 stages done; Following the parts: 3 of 20")


def test_nothing_is_printed_in_a_short_time_where_there_is_no_terminal(monkeypatch):
    errors = io.StringIO()
    monkeypatch.setattr(sys, "stderr", errors)
    with Bar() as bar, bar("paths"):
        doing("stretching plate: 7 full solutions, error 2e-4", 0.4)
    assert not errors.getvalue()
