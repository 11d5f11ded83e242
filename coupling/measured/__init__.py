"""Measured motions as drives: how smooth they are, where they jump, and the pieces that follow them."""

from coupling.measured.fit import MotionFit, fit_motion
