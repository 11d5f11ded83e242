"""Advice: what would make a part move that stayed where it was, or keep one that was lost."""

from coupling.advice.advise import Advice, advice_from, advise, advised_case, moves
from coupling.advice.setting import Setting, Trial
from coupling.advice.thresholds import BEFORE, LEAST, RANGE, Thresholds
from coupling.advice.trials import MAX_SLOPE, MAX_STRAIN, Trials

__all__ = [
    "BEFORE",
    "LEAST",
    "MAX_SLOPE",
    "MAX_STRAIN",
    "RANGE",
    "Advice",
    "Setting",
    "Thresholds",
    "Trial",
    "Trials",
    "advice_from",
    "advise",
    "advised_case",
    "moves",
]
