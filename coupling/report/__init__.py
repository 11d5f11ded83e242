"""The report of a run: what the device is, the lines that the command prints, and its warnings."""

from coupling.report.device import device
from coupling.report.lines import lines, trust
from coupling.report.margins import LIFTS, PULLS, margin_lines, trial_text
from coupling.report.warnings import warnings
from coupling.report.wording import joined, with_micro_signs
