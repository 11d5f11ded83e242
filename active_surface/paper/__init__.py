"""The paper, reproduced: its figures in three models side by side, judged by one table of its statements."""

import lazy_loader

__getattr__, __dir__, _ = lazy_loader.attach_stub(__name__, __file__)

__all__ = [  # public; the stub beside has also what other packages of the program use
    "FULL",
    "PARAMETERS",
    "Parameters",
    "QUICK",
    "Verdict",
    "reproduce",
]
