"""A plate that stretches: its reduced model, kept on disk, and the drives of its corrections over time."""

from coupling.stretch.corrections import Corrections, correction_drives
