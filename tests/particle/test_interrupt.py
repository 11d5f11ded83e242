"""Ctrl-C: heard whatever the thread that waits is doing, and not while something must not be broken off."""

import signal
import subprocess
import sys
import threading
import time
from functools import partial

import pytest

from particle import ConstantFriction, Drive, Micropart, platform_surface, simulate
from particle.interrupt import interruptible, side_by_side, unbroken, wait


class Swallower:
    """Ctrl-C arrives in its finaliser, which keeps any exception to itself, as many do."""

    def __del__(self):
        try:
            signal.raise_signal(signal.SIGINT)
            time.sleep(0)
        except BaseException:
            pass


class Dropper:
    """Ctrl-C arrives in its finaliser, from which Python passes on no exception."""

    def __del__(self):
        signal.raise_signal(signal.SIGINT)


@pytest.fixture(autouse=True)
def default_handler():
    assert threading.current_thread() is threading.main_thread()
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    signal.signal(signal.SIGINT, before)


@pytest.mark.parametrize("kind", [Swallower, Dropper])
def test_ctrl_c_in_a_finaliser_ends_a_wait(kind):
    victims = [kind()]

    def ended(seconds):
        victims.clear()
        time.sleep(0.01)
        return time.monotonic() > late

    late = time.monotonic() + 60
    with pytest.raises(KeyboardInterrupt):
        wait(ended)
    assert time.monotonic() < late


def test_ctrl_c_ends_the_wait_for_another_thread():
    over = threading.Event()
    threading.Timer(0.2, lambda: signal.pthread_kill(threading.main_thread().ident, signal.SIGINT)).start()
    with pytest.raises(KeyboardInterrupt):
        interruptible(over.wait, 5)
    over.set()


def test_ctrl_c_ends_the_paths_of_other_threads():
    """As in a notebook, where the process goes on."""
    before, surface = set(threading.enumerate()), platform_surface(Drive(2e-3, 50.0), size=1e-2)
    follow = partial(simulate, surface, Micropart(2e-9, (0.0, 0.0)), ConstantFriction(2e-8))
    follow(1e-3)  # compiles
    work = partial(follow, 1e6)
    threading.Timer(0.5, lambda: signal.pthread_kill(threading.main_thread().ident, signal.SIGINT)).start()
    with pytest.raises(KeyboardInterrupt):
        side_by_side(work, work)
    for thread in set(threading.enumerate()) - before:
        thread.join(10)
        assert not thread.is_alive()


def test_a_wait_gives_back_what_was_found_or_raised():
    assert interruptible(divmod, 7, 2) == (3, 1)
    with pytest.raises(ZeroDivisionError):
        interruptible(divmod, 7, 0)


def test_tasks_run_side_by_side_and_answer_in_their_order():
    both = threading.Barrier(2, timeout=5)
    assert side_by_side(lambda: both.wait() * 0 + 1, lambda: both.wait() * 0 + 2) == [1, 2]


def test_of_tasks_that_fail_the_first_counts_once_all_have_ended():
    late = threading.Event()

    def fail_late():
        time.sleep(0.05)
        late.set()
        raise KeyError

    with pytest.raises(KeyError):
        side_by_side(fail_late, lambda: divmod(7, 0))
    late.clear()
    with pytest.raises(ZeroDivisionError):
        side_by_side(lambda: divmod(7, 0), fail_late)
    assert late.is_set()


def test_a_wait_on_another_thread_leaves_the_signal_alone():
    assert interruptible(interruptible, divmod, 7, 2) == (3, 1)


def test_what_comes_where_nothing_must_be_broken_off_is_heard_after_it():
    over, done = threading.Event(), []

    def press(seconds):
        signal.raise_signal(signal.SIGINT)
        over.set()
        return True

    with pytest.raises(KeyboardInterrupt), unbroken():
        signal.raise_signal(signal.SIGINT)
        wait(press)
        done.append(1)
    assert over.is_set() and done == [1]


def test_where_ctrl_c_is_not_heard_it_stays_so():
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    with unbroken():
        signal.raise_signal(signal.SIGINT)
    assert signal.signal(signal.SIGINT, signal.default_int_handler) is signal.SIG_IGN


def test_a_handler_that_python_does_not_know_is_left_in_place(monkeypatch):
    monkeypatch.setattr(signal, "getsignal", lambda number: None)
    with unbroken():
        wait(lambda seconds: True)


def test_a_handler_of_somebody_else_is_left_in_place():
    heard = []
    signal.signal(signal.SIGINT, lambda *_: heard.append(1))
    wait(lambda seconds: signal.raise_signal(signal.SIGINT) or True)
    signal.signal(signal.SIGINT, signal.default_int_handler)
    assert heard == [1]


def test_ctrl_c_that_arrives_in_a_kernel_is_raised_after_it(tmp_path):
    """Not as numba makes the named tuple that it returns, where the process crashed."""
    code = """
import math, signal, threading
from typing import NamedTuple
from particle.jit import jit

class Found(NamedTuple):
    value: float

@jit
def spin(turns):
    value = 0.0
    for k in range(turns):
        value = math.sin(value + k)
    return Found(value)

spin(1)
threading.Timer(0.05, lambda: signal.pthread_kill(threading.main_thread().ident, signal.SIGINT)).start()
try:
    spin(30_000_000)
except KeyboardInterrupt:
    print("raised")
"""
    path = tmp_path / "program.py"
    path.write_text(code)
    done = subprocess.run([sys.executable, path], capture_output=True, text=True)
    assert (done.returncode, done.stdout, done.stderr) == (0, "raised\n", "")
