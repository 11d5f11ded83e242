"""Verdict: what the paper says, what we find in three models, and whether the paper's own scheme agrees."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final, NamedTuple

from scipy.stats import binomtest

from active_surface.paper.bench import CLOSED, MODELS, PAPER

REPRODUCED, PARTLY, NOT, BEYOND = "reproduced", "partly", "not", "beyond the paper"
NEARLY_ALL, HARDLY_ANY = 0.9, 0.1  # shares of starts at which a statement is met, or not met
SAME: Final = "as our equations: no scheme in it"
Numbers = Mapping[str, Any]  # what was measured, by name, in SI units


class Share(NamedTuple):
    """How many of all starts do something."""

    hits: int
    of: int

    @property
    def value(self) -> float:
        """0 to 1."""
        return self.hits / self.of

    @property
    def interval(self) -> tuple[float, float]:
        """Lower and upper end of Wilson's interval of 95 % for the true share, 0 to 1."""
        low, high = binomtest(self.hits, self.of).proportion_ci(method="wilson")
        return float(low), float(high)

    @property
    def met(self) -> float:
        """1 or 0 where the whole interval lies above or below those shares, else a half."""
        low, high = self.interval
        return 1.0 if low >= NEARLY_ALL else 0.0 if high <= HARDLY_ANY else 0.5

    def __str__(self) -> str:
        low, high = self.interval
        return f"{100 * self.value:.0f} % ({100 * low:.0f}-{100 * high:.0f})"


def share_of(holds: Iterable[bool]) -> Share:
    """The share of those that hold."""
    every = [bool(one) for one in holds]
    return Share(sum(every), len(every))


class Answer(NamedTuple):
    """The answer of one model: a text as short as a cell, and the share of the statement that it meets."""

    text: str
    met: float  # 0 to 1

    @property
    def verdict(self) -> str:
        """Whether all of the statement holds in this model, some of it, or nothing."""
        return REPRODUCED if self.met >= 1 else NOT if self.met <= 0 else PARTLY


class Statement(NamedTuple):
    """A row of the table: a sentence of the paper, and how numbers answer it."""

    figure: str
    says: str  # the paper's, in our words
    text: Callable[[Numbers], str] = lambda n: str(n["share"])  # a model's answer, from what was measured in it
    checks: Callable[[Numbers], Sequence[float | Share]] = lambda n: [n["share"]]  # each 1 where it is met, 0 where not
    beyond: bool = False  # no statement of the paper: nothing to judge
    how: str = ""  # it is judged, where the sentence leaves that open

    def answer(self, numbers: Numbers) -> Answer:
        """The answer that numbers give."""
        met = [one.met if isinstance(one, Share) else float(one) for one in self.checks(numbers)]
        return Answer(self.text(numbers), sum(met) / len(met))

    def judged(self, numbers: Mapping[str, Numbers]) -> Verdict:
        """The verdict from numbers by model, or by "model, surface"; other names are only kept.

        Of two surfaces the one that meets more counts, as the paper does not say which is its own.
        """
        answers: dict[str, Answer] = {}
        for model in MODELS:
            names = {name: name.partition(", ")[2] for name in numbers if name.partition(", ")[0] == model}
            own = {surface: self.answer(numbers[name]) for name, surface in names.items()}
            if own:
                texts = [f"{surface}: {one.text}" if surface else one.text for surface, one in own.items()]
                answers[model] = Answer(", ".join(texts), max(one.met for one in own.values()))
        if CLOSED in answers and PAPER not in answers:
            answers = {PAPER: Answer(SAME, answers[CLOSED].met)} | answers
        return Verdict(self.figure, self.says, answers, numbers, self.beyond)


@dataclass(frozen=True)
class Verdict:
    """The verdict is that of the paper's own scheme; the other models answer for themselves."""

    figure: str
    statement: str  # the paper's, in our words
    answers: dict[str, Answer]  # by model
    numbers: Mapping[str, Numbers]  # what was measured, by model or otherwise, in SI units
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
            "numbers": self.numbers,
        }
