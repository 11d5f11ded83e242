"""Full answers: a run and what its page shows, for when the hand rests."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from numpy.typing import NDArray

from active_surface.views import run_data
from coupling import (
    Output,
    ProgressCallback,
    Result,
    SolvedPlates,
    case_warnings,
    limit_warnings,
    read_run,
    report,
    run_over,
)
from coupling.case import Case
from particle import Stopped, stoppable

Tell = Callable[[str, int, int], object]
"""Gets a stage, and how many of its pieces are done, and of how many; raises Superseded where nobody waits any more."""


class Superseded(Exception):
    """Another request took the place of the one that is worked on."""


@dataclass(frozen=True, eq=False)
class Full:
    """A result, and what the page shows of it."""

    result: Result
    shown: dict[str, Any]


def full_answer(case: Case, plates: SolvedPlates, tell: Tell, stop: NDArray[np.int64]) -> Full:
    """Run a case as `active-surface run` does.

    stop: (1,), what another thread sets to 1 where nobody waits any more.
    Raises ValueError where the case cannot be run, and Superseded.
    """
    try:
        with stoppable(stop):
            return _full_answer(case, plates, tell)
    except Stopped:
        raise Superseded from None


def _full_answer(case: Case, plates: SolvedPlates, tell: Tell) -> Full:

    @contextmanager
    def progress(stage: str) -> Iterator[ProgressCallback]:
        tell(stage, 0, 0)
        yield lambda done, of: tell(stage, done, of)

    with TemporaryDirectory(prefix="active-surface-") as folder:
        scene = plates.scene(case, progress)
        result = run_over(case, scene, Output(Path(folder), picture=False), progress)
        tell("Drawing", 0, 0)
        data = run_data(read_run(Path(folder, case.name)))
    summary = result.summary
    return Full(
        result,
        {
            "data": data,
            "sentence": report.with_micro_signs(summary.sentence),
            "trust": report.with_micro_signs(report.trust(summary)),
            "warnings": [
                report.with_micro_signs(text)
                for text in [*report.warnings(summary), *case_warnings(case), *limit_warnings(case, result.shapes)]
            ],
            "rows": [[label, report.with_micro_signs(text)] for label, text in report.lines(summary)],
            "figures": {"distance": summary.distance, "end": summary.end_position, "outcome": summary.outcome},
        },
    )
