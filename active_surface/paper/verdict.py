"""Verdict: what the paper says of a figure, what we find in three models, and whether the paper's own scheme agrees."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from active_surface.paper.models import PAPER

REPRODUCED, PARTLY, NOT, BEYOND = "reproduced", "partly", "not", "beyond the paper"


class Answer(NamedTuple):
    """The answer of one model: a text as short as a cell, the share of the statement that it meets, and details."""

    text: str
    met: float  # 0 to 1
    more: str = ""

    @property
    def verdict(self) -> str:
        """Whether all of the statement holds in this model, some of it, or nothing."""
        return REPRODUCED if self.met >= 1 else NOT if self.met <= 0 else PARTLY


@dataclass(frozen=True)
class Verdict:
    """The verdict is that of the paper's own scheme; the other models answer for themselves."""

    figure: str
    statement: str  # the paper's, in our words
    answers: dict[str, Answer]  # by model
    why: str  # what makes the difference, or what the agreement rests on
    numbers: dict[str, Any] = field(default_factory=dict)  # what was measured, by name, in SI units
    beyond: bool = False  # no statement of the paper: nothing to judge

    @property
    def verdict(self) -> str:
        """Of the paper's scheme."""
        return BEYOND if self.beyond else self.answers[PAPER].verdict

    def as_dict(self) -> dict[str, Any]:
        """For a JSON file."""
        return {
            "figure": self.figure,
            "statement": self.statement,
            "answers": {
                key: answer._asdict() | ({} if self.beyond else {"verdict": answer.verdict})
                for key, answer in self.answers.items()
            },
            "verdict": self.verdict,
            "why": self.why,
            "numbers": self.numbers,
        }


def of_checks(text: str, checks: Sequence[bool], more: str = "") -> Answer:
    """An answer whose share of the statement is that of the checks it passes."""
    return Answer(text, sum(map(bool, checks)) / len(checks), more)
