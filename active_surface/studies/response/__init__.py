"""Frequency responses: how far points of a plate with mass follow its actuators, over frequency."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
