"""Reduction: a plate that stretches in a few shapes, which full solutions give, with or without mass."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
