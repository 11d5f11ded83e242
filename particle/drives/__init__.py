"""Drives: how far an actuator is raised over time."""

from particle.drives.drive import (
    ORDER,
    AnyDrive,
    accelerations,
    drive_kink,
    drive_piece,
    drive_table,
    kink_slack,
    monomial_table,
    next_kink,
)
from particle.drives.table import DriveTable
