"""Drives: how far an actuator is raised over time."""

from particle.drives.drive import (
    ORDER,
    AnyDrive,
    accelerations,
    breakpoint_slack,
    drive_breakpoint,
    drive_piece,
    drive_table,
    monomial_table,
    next_breakpoint,
)
from particle.drives.table import DriveTable
