"""The paper's statements over all readings of what it leaves open, as one sweep and one page."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
