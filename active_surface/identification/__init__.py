"""Identification: the fields of cases with which paths are closest to measured positions of a part."""

import lazy_loader

__getattr__, __dir__, _ = lazy_loader.attach_stub(__name__, __file__)

__all__ = ["Estimate", "Identified", "Track", "TrackFit", "identify", "read_track"]  # public
