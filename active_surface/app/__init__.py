"""App: a case in the browser, whose path is drawn anew while its fields are dragged."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
