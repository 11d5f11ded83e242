"""Membranes: what stretching adds to a plate's energy, by Airy's stress function or in-plane motion."""

from fem_plate.large_deflection.membranes.airy import airy, airy_corners
from fem_plate.large_deflection.membranes.membrane import AIRY, PLANE_STRESS, Membrane
from fem_plate.large_deflection.membranes.plane_stress import PlaneStress
from fem_plate.large_deflection.membranes.samples import Samples, halves, strains, thirds, times
