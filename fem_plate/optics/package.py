"""The package that reads and writes FITS files, which is an extra."""

from __future__ import annotations

from typing import Any


def fits_package() -> Any:
    """astropy's module of FITS; ValueError, which says how to get it, where it is not installed."""
    try:
        from astropy.io import fits  # here, as it takes a while
    except ImportError:
        how = "pip install 'active-surface[optics]'"
        raise ValueError(f"FITS files of influence functions need astropy, which comes with {how}") from None
    return fits
