"""Influence functions for adaptive optics: FITS files of three layouts, and fits to measured functions."""

from fem_plate.optics.fitting import InfluenceFit, fit_influence
from fem_plate.optics.layouts import LAYOUTS, Layout, save_fits
from fem_plate.optics.measured import MeasuredInfluence, read_influence
