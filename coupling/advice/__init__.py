"""Advice: a search for what would make a part move that stayed where it was, or keep one that was lost."""

from coupling.advice.choices import Choice
from coupling.advice.trials import Setting, Trial, Trials, advise, no_advice
from coupling.advice.wording import ADVISED, advice_text, advised_case

__all__ = ["ADVISED", "Choice", "Setting", "Trial", "Trials", "advice_text", "advise", "advised_case", "no_advice"]
