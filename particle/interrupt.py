"""Ctrl-C: heard for sure while one thread waits for others, and not at all where something must not be broken off."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Final

AWAKE: Final = 0.1  # s between looks


def wait(ended: Callable[[float], bool]) -> None:
    """Wait until `ended`, which itself waits for so many seconds, says so; KeyboardInterrupt upon Ctrl-C.

    An exception that a signal raises is lost where Python has nowhere to pass it on to, as in a finaliser that happens
    to run then. So Ctrl-C only leaves a note here, and the loop looks for it. Where somebody else handles the signal,
    or this is not the main thread, it is left to them.
    """
    noted = threading.Event()
    with _handled(lambda *_: noted.set(), signal.default_int_handler):
        while not noted.is_set() and not ended(AWAKE):
            pass
    if noted.is_set():
        raise KeyboardInterrupt


@contextmanager
def unbroken() -> Iterator[None]:
    """Lets no Ctrl-C into its block, so that what was found is not lost; one that came is raised after it.

    Does nothing on a thread that gets none, and where none is heard anyway.
    """
    noted = threading.Event()
    # A handler, not SIG_IGN: Ctrl-C that somebody sends once more, as it was dropped, does nothing while that is set.
    with _handled(lambda *_: noted.set()):
        yield
    if noted.is_set():
        signal.raise_signal(signal.SIGINT)


@contextmanager
def _handled(handler: Callable[..., object], instead_of: object = None) -> Iterator[None]:
    """Has Ctrl-C handled so, on the main thread, in place of the handler given, or of any that Python can put back."""
    before = signal.getsignal(signal.SIGINT)
    ours = before is instead_of if instead_of else before not in (None, signal.SIG_IGN)
    if threading.current_thread() is not threading.main_thread() or not ours:
        yield
        return
    signal.signal(signal.SIGINT, handler)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
