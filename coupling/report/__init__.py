"""The report of a run: what the device is, the lines that the command prints, and its warnings."""

from coupling.report.device import device
from coupling.report.lines import LIFTS, PULLS, lines, lines_of_parts, margin_lines, trust, with_micro_signs
from coupling.report.warnings import MAX_DEFLECTION, MAX_QUASI_STATIC_ERROR, about, warnings, warnings_of_parts
