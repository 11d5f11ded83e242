"""Drives: how far an actuator is raised over time."""

from particle.drives.pieces import (
    NO_SEGMENT,
    ORDER,
    DriveTable,
    breakpoint_slack,
    copy_rows,
    drive_breakpoint,
    drive_piece,
    evaluate_piece,
    expand_piece,
    find_piece,
    next_breakpoint,
    quintic_at,
    quintic_end,
    shift_quintic,
)
from particle.drives.points import QuinticDrive, quintic_drives
from particle.drives.quintics import begun_at
from particle.drives.table import AnyDrive, Segments, accelerations, drive_table, horizon, monomial_table, scaled_table
