"""Answers: the path of a case at once, all of its run where the hand rests, and a search that is watched.

They are found on lanes, threads that work for the page, so that quick answers never wait for long ones.
"""

from __future__ import annotations

import asyncio
import json
import re
import traceback
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from typing import Any, Final, TypeVar

import numpy as np
from numpy.typing import NDArray

from active_surface.app.aiming import Search
from active_surface.app.drawn import drift_of, face_of, path_of, unit_of
from active_surface.app.full import Full, Superseded, full_answer
from active_surface.app.quick import QuickPaths
from active_surface.steering import Aimed
from active_surface.studies.drifts import drift
from coupling import Progress, ProgressCallback, SolvedPlates, ground_key, report
from coupling.case import Case, InputError
from particle import Trajectory

Answer = TypeVar("Answer")

KEPT_PLATES: Final = 4
ACROSS: Final = 12  # places that parts are followed from, along the plate's longer side
FULL: Final = 4  # threads of runs: one may take seconds to hear that nobody waits for it
TEXT: Final = re.compile(r'("(?:[^"\\]|\\.)*")')  # in quotes, as `quoted` writes it
Send = Callable[[dict[str, Any]], object]
Mistakes = list[tuple[str, str]]
"""Fields, and what is wrong with each."""


class Refused(ValueError):
    """What somebody did on the page makes no sense."""

    def __init__(self, mistakes: Mistakes) -> None:
        super().__init__(mistakes)
        self.mistakes = mistakes


def mistakes_of(error: Exception, field: str = "") -> Mistakes | None:
    """What is wrong where work for the page raised an error; None: it is a mistake of the program."""
    if isinstance(error, Refused):
        return error.mistakes
    if isinstance(error, InputError):
        return error.problems
    if isinstance(error, ValueError | OSError):
        return [(field, text.removeprefix(f"{field} ")) for text in str(error).split("\n")]
    return None


def as_typed(message: str) -> str:
    """A message whose texts stand as they are typed on the page, without the quotes that they have in a file."""
    pieces = TEXT.split(message)
    return "".join(
        json.loads(one) or "nothing" if k % 2 else report.with_micro_signs(one) for k, one in enumerate(pieces)
    )


class Lanes:
    """What all tabs share: threads, plates that were solved, and quick paths over them."""

    def __init__(self) -> None:
        self.plates = SolvedPlates(keep=KEPT_PLATES)
        self.quick_paths = QuickPaths(self.plates)
        self.quick = ThreadPoolExecutor(1, "quick")
        self.full = ThreadPoolExecutor(FULL, "full")
        self.models = ThreadPoolExecutor(1, "models")
        self._closed = False

    async def run(self, lane: ThreadPoolExecutor, work: Callable[..., Answer], *arguments: object) -> Answer:
        """work(*arguments) on a lane; cancelled once that takes no more work."""
        if self._closed:
            raise asyncio.CancelledError
        return await asyncio.get_running_loop().run_in_executor(lane, work, *arguments)

    def close(self) -> None:
        """Take no more work."""
        self._closed = True
        for lane in (self.quick, self.full, self.models):
            lane.shutdown(wait=False, cancel_futures=True)


class Answers:
    """What is sent to a tab about its case; of what answers an earlier case nothing is sent any more."""

    def __init__(self, lanes: Lanes) -> None:
        self.send: Send = lambda message: None  # while nobody is connected
        self.full: Full | None = None
        self._lanes, self._stop = lanes, np.zeros(1, np.int64)  # 1 once the case is another one
        self._ground = ("", 0.0)  # what models of the plate of the case follow from
        self._search: Search | None = None
        self._drift: object = None  # a token of that which is wanted
        self._tasks: set[asyncio.Task[None]] = set()

    def forget(self) -> None:
        """Answer no more of what was asked before."""
        self.full = self._drift = None
        self._stop[0] = 1
        self._stop = np.zeros(1, np.int64)

    def close(self) -> None:
        """The tab is gone for good."""
        self.forget()
        self._ground = ("", 0.0)
        self.send = lambda message: None
        self.stop()

    async def answer(self, case: Case, saved: bool, rest: bool, page_turn: object = None) -> None:
        """The quick path of a case, and all of its run where the hand rests; saved: whether it is as it is saved."""
        stop, self._ground = self._stop, (ground_key(case), case.run.duration)
        try:
            quick = await self._lanes.run(self._lanes.quick, self._lanes.quick_paths.of, case, rest)
        except Exception as error:
            self.tell_error(error, page_turn)
            return
        if quick is None:
            self.send({"kind": "later", "turn": page_turn})
        elif not stop[0]:
            drawn = path_of(quick.path, unit_of(case), quick.error) | {"face": face_of(case)}
            self.send({"kind": "path", "turn": page_turn, "coarse": list(quick.coarse), "rest": rest, **drawn})
        else:  # another case has come in its place, but the page waits for an answer
            self.send({"kind": "passed", "turn": page_turn})
        if rest:
            self.spawn(self._run(case, saved, stop))

    async def _run(self, case: Case, saved: bool, stop: NDArray[np.int64]) -> None:
        busy = self._from_thread()

        def tell(stage: str, done: int, of: int) -> None:
            if stop[0]:
                raise Superseded
            busy({"kind": "busy", "stage": stage, "done": done, "of": of})

        try:
            full = await self._lanes.run(self._lanes.full, full_answer, case, self._lanes.plates, tell, stop)
        except Superseded:
            return
        except Exception as error:
            if not stop[0]:
                self.send({"kind": "idle"})
                self.tell_error(error)
            return
        if not stop[0]:
            self.full = full
            drawn = path_of(full.result.trajectory, unit_of(case))
            self.send({"kind": "run", **drawn, **full.shown, "saved": saved})
            self.spawn(self._prepare(case))

    async def _prepare(self, case: Case) -> None:
        """Make quick paths possible over a plate that stretches or vibrates."""
        ground = self._ground

        def wanted() -> bool:
            return ground == self._ground

        try:
            work = self._lanes.quick_paths.prepare
            if wanted():
                await self._lanes.run(
                    self._lanes.models, work, case, _noting(self._from_thread(), wanted, "Preparing quick paths")
                )
        except Superseded:
            return
        except ValueError:  # of strokes beyond those of the case, which may ask too much
            pass
        except Exception as error:
            self.tell_error(error)
        if wanted() and not self.searching:
            self.send({"kind": "idle"})

    async def drift(self, case: Case, on: bool) -> None:
        """Find where parts go from everywhere under the drives of a case; on: whether it is still wanted."""
        self._drift = token = object() if on else None
        if not on:
            self.send({"kind": "idle"})
            return

        def wanted() -> bool:
            return self._drift is token

        def work() -> dict[str, Any]:
            progress = _noting(found, wanted, "Where parts go")
            return drift_of(drift(case, across=ACROSS, threads=1, progress=progress, plates=self._lanes.plates), unit)

        unit, found = unit_of(case), self._from_thread()
        try:
            shown = await self._lanes.run(self._lanes.full, work)
        except Superseded:
            return
        except ValueError as error:  # there is no such map
            shown = {"text": as_typed(str(error).removeprefix("Input case of drift "))}
        except Exception as error:
            self.tell_error(error)
            return
        if wanted():
            self.send({"kind": "drift", **shown})

    @property
    def searching(self) -> bool:
        """Whether a search is on."""
        return self._search is not None

    def aim(self, search: Search, take: Callable[[Case], object]) -> None:
        """Search for drives; take: gets the case with them.

        Raises Refused while another search is on.
        """
        if self._search is not None:
            raise Refused([("", "a search is on: stop it first")])
        self._search = search
        self.spawn(self._aim(search, take))

    def stop(self) -> None:
        """End the search, if there is one, with its best drives so far."""
        if self._search is not None:
            self._search.stop()

    async def _aim(self, search: Search, take: Callable[[Case], object]) -> None:
        unit, found = unit_of(search.case), self._from_thread()

        def watch(done: int, of: int, left: float, best: Trajectory | None) -> None:
            shown = {} if best is None else path_of(best, unit) | {"away": search.away(best)}
            found({"kind": "search", "done": done, "of": of, "left": left, **shown})

        try:
            result: Aimed | None = await self._lanes.run(self._lanes.full, search.run, watch)
        except Exception as error:
            self.send({"kind": "found", "text": "", "good": False})
            self.tell_error(error, field="target")
            return
        finally:
            self._search = None
        if result is None:
            self.send({"kind": "found", "text": "The search was stopped before it had any drives.", "good": False})
            return
        self.send({"kind": "found", "text": search.text(result), "good": result.reached})
        if not search.helps(result):
            return
        take(result.case.model_copy(update={"name": search.case.name}))

    def tell_error(self, error: Exception, page_turn: object = None, field: str = "") -> None:
        """Mistakes at their fields; of one of the program a sentence, and its traceback for whoever started it."""
        mistakes = mistakes_of(error, field)
        if mistakes is None:
            traceback.print_exception(error)
            self.send({"kind": "trouble", "turn": page_turn, "text": f"the program failed: {error!r}"})
            return
        told = [{"field": name, "message": as_typed(message)} for name, message in mistakes]
        self.send({"kind": "refused", "turn": page_turn, "mistakes": told})

    def spawn(self, work: Any) -> None:
        """Let a coroutine go on by itself."""
        task = asyncio.get_running_loop().create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    def _from_thread(self) -> Send:
        """What sends from another thread."""
        loop = asyncio.get_running_loop()
        return lambda message: loop.call_soon_threadsafe(self.send, message)


def _noting(send: Send, wanted: Callable[[], bool], what: str) -> Progress:
    """A progress that tells the page its stages; Superseded once it is not wanted any more."""

    @contextmanager
    def progress(stage: str) -> Iterator[ProgressCallback]:
        text = f"{what}: {stage[0].lower()}{stage[1:]}"

        def tell(done: int, of: int) -> None:
            if not wanted():
                raise Superseded
            send({"kind": "busy", "stage": text, "done": done, "of": of})

        tell(0, 0)
        yield tell

    return progress
