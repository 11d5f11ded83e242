"""Compilation of kernels: when it begins. It happens once, as they are kept on disk."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager


@contextmanager
def compilation_heard(tell: Callable[[], object]) -> Iterator[None]:
    """Calls `tell` when the first kernel is compiled, on whatever thread; never where all of them are on disk."""
    from numba.core import event  # with the kernels, not before

    class Once(event.Listener):
        heard = False

        def on_start(self, started: object) -> None:
            if not self.heard:
                self.heard = True
                tell()

        def on_end(self, ended: object) -> None:
            pass

    with event.install_listener("numba:compile", Once()):
        yield
