"""Advice: a search for what would make a part move that stayed where it was, or keep one that was lost."""

from coupling.advice.advise import ADVISED, Advice, advise, advised_case
from coupling.advice.setting import Setting, Trial
from coupling.advice.trials import Trials
from coupling.advice.words import trial_text

__all__ = ["ADVISED", "Advice", "Setting", "Trial", "Trials", "advise", "advised_case", "trial_text"]
