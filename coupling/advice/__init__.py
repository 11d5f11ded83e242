"""Advice: a search for what would make a part move that stayed where it was, or keep one that was lost."""

from coupling.advice.advise import ADVISED, Advice, advise, advised_case, trial_text
from coupling.advice.trials import Setting, Trial, Trials

__all__ = ["ADVISED", "Advice", "Setting", "Trial", "Trials", "advise", "advised_case", "trial_text"]
