"""The command `active-surface`: what its commands have in common, and these in a room of their own."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
