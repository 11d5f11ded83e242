"""Checking: what the tables of a case ask of each other, once each is right by itself."""

from coupling.case.checks.check import MAY_MOVE, build
from coupling.case.checks.theories import MAX_STRETCHING, MAX_VIBRATING, common_period
