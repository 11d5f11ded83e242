"""Drift: where drives carry a part from everywhere on a plate, a period at a time, and where it ends."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
