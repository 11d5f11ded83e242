"""Session: one tab of the browser, its case, and the answers to what is done there."""

from __future__ import annotations

import asyncio
import base64
import io
import math
import sys
import traceback
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from functools import partial
from typing import Any, Final

from active_surface.app.aiming import Search
from active_surface.app.drawn import map_of, path_of, unit_of
from active_surface.app.full import Full, Superseded, full_answer
from active_surface.app.knobs import ALL, allowed, changes_of, knobs_of
from active_surface.app.lanes import Lanes
from active_surface.app.opened import Opened, example_cases, open_example
from coupling import Progress, ProgressCallback, report
from coupling.case import Case, InputError, PlateCase

Message = Mapping[str, Any]
Send = Callable[[dict[str, Any]], object]

DOTS: Final = 150  # per inch, of the picture


class Refused(ValueError):
    """What somebody did on the page makes no sense; `mistakes` has fields and what is wrong with each."""

    def __init__(self, mistakes: list[tuple[str, str]]) -> None:
        super().__init__(mistakes)
        self.mistakes = mistakes


class Session:
    """A tab."""

    def __init__(self, lanes: Lanes, opened: Opened | None) -> None:
        self.send: Send = lambda message: None  # while nobody is connected
        self._lanes, self._opened, self._selected = lanes, opened, "0"
        self._turn = 0  # of the latest case: what answers an earlier one is dropped
        self._full: Full | None = None
        self._search: Search | None = None
        self._waiting: list[Message] = []
        self._working = False
        self._tasks: set[asyncio.Task[None]] = set()

    def start(self) -> None:
        """Show what there is, to a page that has just connected."""
        if self._opened is None:
            self.send({"kind": "menu", "examples": [[name, about] for name, about in example_cases().items()]})
        else:
            self._show_case()
            self._spawn(self._answer(rest=True))

    def take(self, message: object) -> None:
        """Take a message of the page; of what is dragged only the latest that waits counts."""
        if not isinstance(message, dict) or not isinstance(message.get("do"), str):
            self._refuse([("", 'must be a message with "do"')])
            return
        last = self._waiting[-1] if self._waiting else {}
        if message["do"] == last.get("do") == "set" and message.get("gesture") == last.get("gesture"):
            self._waiting.pop()
            message = {**message, "changes": {**last.get("changes", {}), **message.get("changes", {})}}
        self._waiting.append(message)
        if not self._working:
            self._working = True
            self._spawn(self._work())

    def close(self) -> None:
        """The tab is gone for good."""
        self._turn += 1
        self.send = lambda message: None
        if self._search is not None:
            self._search.stop()

    async def _work(self) -> None:
        try:
            while self._waiting:
                await self._do(self._waiting.pop(0))
        finally:
            self._working = False

    async def _do(self, message: Message) -> None:
        work = getattr(self, f"_do_{message['do']}", None)
        try:
            if work is None:
                raise Refused([("", f"there is nothing to do that is called {message['do']}")])
            if self._opened is None and message["do"] != "open":
                raise Refused([("", "there is no case yet: choose an example")])
            await work(message)
        except Refused as error:
            self._refuse(error.mistakes, message.get("turn"))
        except InputError as error:
            self._refuse(error.problems, message.get("turn"))
        except (ValueError, OSError) as error:
            self._refuse([("", str(error))], message.get("turn"))
        except Exception as error:
            self._failed(error)

    # What the page can do.

    async def _do_open(self, message: Message) -> None:
        opened = open_example(str(message.get("name")))
        self._opened, self._selected, self._full = opened, "0", None
        self._turn += 1
        self._show_case()
        await self._answer(rest=True)

    async def _do_set(self, message: Message) -> None:
        opened = self._case_open
        changes = message.get("changes")
        if not isinstance(changes, dict) or not all(isinstance(text, str) for text in changes.values()):
            raise Refused([("", "must change fields to texts")])
        wanted: dict[str, Any] = {}
        for path, text in changes.items():
            if not allowed(opened.case, path):
                raise Refused([(path, "must be a field that the page has")])
            try:
                wanted |= changes_of(opened.case, path, text)
            except ValueError as error:
                raise Refused([(path, str(error))]) from None
        case = await self._lanes.run(self._lanes.quick, opened.case.vary, wanted)
        opened.change(case, message.get("gesture"))
        self._turn += 1
        await self._answer(bool(message.get("rest")), message.get("turn"))
        if message.get("rest"):
            self._show_case()

    async def _do_rest(self, message: Message) -> None:
        """The hand has let go of what it dragged."""
        self._case_open.gesture = None
        self._show_case()
        await self._answer(rest=True)

    async def _do_select(self, message: Message) -> None:
        chosen = str(message.get("actuator"))
        count = len(self._case_open.case.actuators)
        if chosen != ALL and not (chosen.isdecimal() and int(chosen) < count):
            raise Refused([("", f"must be the number of an actuator, of {count}, or {ALL} for all; got {chosen}")])
        self._selected = chosen
        self._show_case()

    async def _do_undo(self, message: Message) -> None:
        await self._stepped(self._case_open.undo())

    async def _do_redo(self, message: Message) -> None:
        await self._stepped(self._case_open.redo())

    async def _do_back(self, message: Message) -> None:
        """Back to the case as it is saved, a step like any other."""
        self._case_open.change(self._case_open.saved, None)
        await self._stepped(True)

    async def _do_save(self, message: Message) -> None:
        path = self._case_open.save(str(message.get("name")), bool(message.get("replace")))
        self.send({"kind": "note", "text": f"Saved {path}"})
        self._show_case()
        await self._answer(rest=True)

    async def _do_picture(self, message: Message) -> None:
        if self._full is None:
            raise Refused([("", "there is no run yet to draw")])
        data = await self._lanes.run(self._lanes.full, _picture, self._full)
        self.send({"kind": "picture", "name": f"{self._case_open.case.name}.png", "bytes": data})

    async def _do_aim(self, message: Message) -> None:
        target = message.get("target")
        numbers = isinstance(target, list) and len(target) == 2 and all(type(c) in (int, float) for c in target)
        if not numbers or not all(math.isfinite(c) for c in target):
            raise Refused([("target", "must be two numbers, x and y in m")])
        if self._search is not None:
            raise Refused([("target", "there is a search already: stop it first")])
        x, y = target
        self._search = Search(self._case_open.case, (float(x), float(y)))
        self._spawn(self._aim(self._search))

    async def _do_stop(self, message: Message) -> None:
        if self._search is not None:
            self._search.stop()

    # How it is answered.

    @property
    def _case_open(self) -> Opened:
        assert self._opened is not None
        return self._opened

    async def _stepped(self, done: bool) -> None:
        if done:
            self._turn += 1
            self._show_case()
            await self._answer(rest=True)

    async def _answer(self, rest: bool, page_turn: object = None) -> None:
        """The path of the case at once, and all of the run where the hand rests."""
        case, turn = self._case_open.case, self._turn
        try:
            quick = await self._lanes.run(self._lanes.quick, self._lanes.quick_paths.of, case)
        except ValueError as error:
            self._refuse([("", str(error))], page_turn)
            return
        if quick is not None and turn == self._turn:
            drawn = path_of(quick.path, unit_of(case))
            self.send({"kind": "path", "turn": page_turn, "coarse": list(quick.coarse), **drawn})
        elif quick is None:
            self.send({"kind": "later", "turn": page_turn})
        if rest:
            self._spawn(self._answer_fully(case, turn))

    async def _answer_fully(self, case: Case, turn: int) -> None:
        loop = asyncio.get_running_loop()

        def tell(stage: str, done: int, of: int) -> None:
            if turn != self._turn:
                raise Superseded
            loop.call_soon_threadsafe(self.send, {"kind": "busy", "stage": stage, "done": done, "of": of})

        try:
            full = await self._lanes.run(self._lanes.full, full_answer, case, self._lanes.plates, tell)
        except Superseded:
            return
        except (ValueError, OSError) as error:
            if turn == self._turn:
                self.send({"kind": "idle"})
                self._refuse([("", str(error))])
            return
        except Exception as error:
            self._failed(error)
            return
        if turn != self._turn:
            return
        self._full = full
        unit = unit_of(case)
        self.send(
            {
                "kind": "run",
                **path_of(full.result.trajectory, unit),
                **full.shown,
                "saved": case is self._case_open.saved,
            }
        )
        self._spawn(self._prepare(case))

    async def _prepare(self, case: Case) -> None:
        """Make quick paths possible over a plate that stretches or vibrates."""
        loop = asyncio.get_running_loop()

        tell = partial(loop.call_soon_threadsafe, self.send)
        try:
            await self._lanes.run(self._lanes.models, self._lanes.quick_paths.prepare, case, _noting(tell))
        except ValueError as error:
            print(f"active-surface app: no quick paths: {error}", file=sys.stderr)
        except Exception as error:
            self._failed(error)
        else:
            self.send({"kind": "idle"})

    async def _aim(self, search: Search) -> None:
        loop = asyncio.get_running_loop()
        unit = unit_of(search.case)

        def watch(done: int, of: int, best: Any) -> None:
            shown = {} if best is None else path_of(best, unit)
            loop.call_soon_threadsafe(self.send, {"kind": "search", "done": done, "of": of, **shown})

        try:
            result = await self._lanes.run(self._lanes.full, search.run, watch)
        except (ValueError, OSError) as error:
            self.send({"kind": "found", "text": ""})
            self._refuse([("target", text) for text in str(error).split("\n")])
            return
        except Exception as error:
            self.send({"kind": "found", "text": ""})
            self._failed(error)
            return
        finally:
            self._search = None
        if result is None:
            self.send({"kind": "found", "text": "The search was stopped before it had any drives."})
            return
        self._case_open.change(result.case.model_copy(update={"name": self._case_open.case.name}), None)
        self.send({"kind": "found", "text": search.text(result)})
        await self._stepped(True)

    def _show_case(self) -> None:
        opened = self._case_open
        case = opened.case
        if self._selected != ALL and int(self._selected) >= len(case.actuators):
            self._selected = "0"
        self.send(
            {
                "kind": "case",
                "name": case.name,
                "file": None if opened.file is None else str(opened.file),
                "folder": str(opened.folder_to_save),
                "device": report.device(case),
                "map": map_of(case),
                "selected": self._selected if isinstance(case.plate, PlateCase) else "",
                "groups": knobs_of(case, self._selected),
                "undo": len(opened.steps),
                "redo": len(opened.undone),
                "changed": opened.case is not opened.saved,
            }
        )

    def _refuse(self, mistakes: list[tuple[str, str]], turn: object = None) -> None:
        told = [{"field": field, "message": report.with_micro_signs(message)} for field, message in mistakes]
        self.send({"kind": "refused", "turn": turn, "mistakes": told})

    def _failed(self, error: Exception) -> None:
        """A mistake of the program: its traceback for whoever started it, a sentence for the page."""
        traceback.print_exception(error)
        self.send({"kind": "trouble", "text": f"the program failed: {error!r}"})

    def _spawn(self, work: Any) -> None:
        task = asyncio.get_running_loop().create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)


def _noting(send: Send) -> Progress:
    """A progress that tells the page its stages."""

    @contextmanager
    def progress(stage: str) -> Iterator[ProgressCallback]:
        text = f"Preparing quick paths: {stage[0].lower()}{stage[1:]}"
        send({"kind": "busy", "stage": text, "done": 0, "of": 0})
        yield lambda done, of: send({"kind": "busy", "stage": text, "done": done, "of": of})

    return progress


def _picture(full: Full) -> str:
    """The picture of a run as base64 of a PNG file, the same that `run` writes."""
    drawing = io.BytesIO()
    full.result.plot().savefig(drawing, format="png", dpi=DOTS)
    return base64.b64encode(drawing.getvalue()).decode()
