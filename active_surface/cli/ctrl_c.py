"""Ctrl-C that is not lost: a KeyboardInterrupt that Python drops comes again, and one in disguise is known."""

from __future__ import annotations

import _thread
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

SOON = 0.05  # s


@contextmanager
def heard_again() -> Iterator[None]:
    """Raises KeyboardInterrupt in its block, or at its end, though one was dropped or became a SystemError.

    Exceptions in a callback or finaliser are dropped: nobody is there to be told but `sys.unraisablehook`. Where
    compiled code goes on after one, Python complains of that in its place.
    """
    before = sys.unraisablehook
    coming: list[threading.Timer] = []

    def hook(dropped: Any) -> None:
        if not issubclass(dropped.exc_type, KeyboardInterrupt):
            before(dropped)
            return
        coming.append(threading.Timer(SOON, _thread.interrupt_main))
        coming[-1].daemon = True
        coming[-1].start()

    sys.unraisablehook = hook
    try:
        yield
    except SystemError as error:
        if isinstance(error.__cause__, KeyboardInterrupt):
            raise error.__cause__ from None
        raise
    finally:
        sys.unraisablehook = before
        still = [timer for timer in coming if timer.is_alive()]
        for timer in still:
            timer.cancel()
        if still:
            raise KeyboardInterrupt
