"""Checks: whether the tables of a case go together."""

from coupling.case.checks.check import Checked, check
from coupling.case.checks.cycles import cycles_fault
from coupling.case.checks.parts import MAY_MOVE
from coupling.case.checks.theories import MAX_STRETCHING, MAX_VIBRATING, common_period
