"""Views: animations, pictures and pages of results.

Names are loaded when they are first used, so that `active-surface --help` does not wait for them.
"""

from coupling.lazy import lazy

_HOMES = {
    "Animation": "views.animation",
    "animate": "views.animation",
    "still": "views.animation",
    "plot": "views.plots",
    "write_run_page": "views.run_page",
    "write_study_page": "views.study_page",
}

__all__ = list(_HOMES)  # noqa: PLE0605

__getattr__, __dir__ = lazy(__name__, _HOMES)
