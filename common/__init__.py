"""What all packages share: drawing, the wording of quantities, and checks of HDF5 files."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
