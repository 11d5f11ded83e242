"""Views: animations, pictures and pages of results."""

import lazy_loader

__getattr__, __dir__, _ = lazy_loader.attach_stub(__name__, __file__)

__all__ = [  # public; the stub beside has also what other packages of the program use
    "Animation",
    "animate",
    "plot",
    "still",
    "write_run_page",
    "write_study_page",
]
