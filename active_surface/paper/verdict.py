"""Verdict: what the paper says of a figure, what we find in three models, and whether that agrees."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

REPRODUCED, PARTLY, NOT, BEYOND = "reproduced", "partly", "not", "beyond the paper"


class Answer(NamedTuple):
    """The answer of one model: a text, and the share of the paper's statement that it meets."""

    text: str
    met: float  # 0 to 1


@dataclass(frozen=True)
class Verdict:
    """The verdict follows from the answers: all met in every model, nothing in any, or else partly."""

    figure: str
    statement: str  # the paper's, in our words
    answers: dict[str, Answer]  # by model
    why: str  # what makes the difference, or what the agreement rests on
    numbers: dict[str, Any] = field(default_factory=dict)  # what was measured, by name, in SI units
    beyond: bool = False  # no statement of the paper: nothing to judge

    @property
    def verdict(self) -> str:
        if self.beyond:
            return BEYOND
        met = [answer.met for answer in self.answers.values()]
        if min(met) >= 1:
            return REPRODUCED
        return NOT if max(met) <= 0 else PARTLY

    def as_dict(self) -> dict[str, Any]:
        """For a JSON file."""
        return {
            "figure": self.figure,
            "statement": self.statement,
            "answers": {key: answer._asdict() for key, answer in self.answers.items()},
            "verdict": self.verdict,
            "why": self.why,
            "numbers": self.numbers,
        }


def of_checks(text: str, checks: Sequence[bool]) -> Answer:
    """An answer whose share of the statement is that of the checks it passes."""
    return Answer(text, sum(map(bool, checks)) / len(checks))
