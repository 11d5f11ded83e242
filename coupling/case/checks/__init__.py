"""Checking: what the tables of a case ask of each other, once each is right by itself."""

from coupling.case.checks.check import build
from coupling.case.checks.theories import MAX_STRETCHING, MAX_VIBRATING, common_period
