"""Plates whose energy is any symmetric form of w and its derivatives: thickness, foundation, users' own forms."""

from fem_plate.general.energy import PlateEnergy, plate_energy
from fem_plate.general.model import GeneralModel
