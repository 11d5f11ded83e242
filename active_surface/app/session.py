"""Session: one tab of the browser, and what can be done there."""

from __future__ import annotations

import base64
import io
import math
from collections.abc import Mapping
from typing import Any, Final

from active_surface.app.aiming import CHOSEN, Search
from active_surface.app.answers import Answers, Lanes, Refused, Send
from active_surface.app.drawn import map_of
from active_surface.app.full import Full
from active_surface.app.knobs import ALL, allowed, changes_of, knobs_of
from active_surface.app.opened import Opened, example_cases, open_example
from active_surface.steering import Settings
from coupling import report
from coupling.case import Case, InputError, PlateCase

Message = Mapping[str, Any]

FIRST, OUTSIDE = ("studies/moderate", "transport"), "Outside"
CHANGING: Final = ("set", "undo", "redo", "back", "open", "save")
DOTS: Final = 150  # per inch, of the picture


class Session:
    """A tab; what the page can do are the methods that begin with `_do_`."""

    def __init__(self, lanes: Lanes, opened: Opened | None) -> None:
        self._lanes, self._opened, self._selected = lanes, opened, "0"
        self._answers = Answers(lanes)
        self._waiting: list[Message] = []
        self._working = False

    def connect(self, send: Send) -> None:
        """Show what there is, to a page that has just connected."""
        self._answers.send = send
        if self._opened is None:
            send(_menu())
        else:
            self._show_case()
            if not self._answers.searching:
                self._answers.spawn(self._answer(rest=True))

    def disconnect(self) -> None:
        """Nobody listens for now."""
        self._answers.send = lambda message: None

    def close(self) -> None:
        """The tab is gone for good."""
        self._answers.close()

    def take(self, message: object) -> None:
        """Take a message of the page; they are worked on one after the other."""
        if not isinstance(message, dict) or not isinstance(message.get("do"), str):
            self._answers.tell_error(Refused([("", 'a message must have "do", the name of what is to be done')]))
            return
        if type(message.get("turn", 0)) is not int:  # it goes back to the page with the answer
            self._answers.tell_error(Refused([("", "turn must be a whole number")]))
            return
        self._waiting.append(message)
        if not self._working:
            self._working = True
            self._answers.spawn(self._work())

    async def _work(self) -> None:
        try:
            while self._waiting:
                message = self._waiting.pop(0)
                try:
                    await self._do(message)
                except Exception as error:
                    self._answers.tell_error(error, message.get("turn"))
                    if message.get("rest") and self._opened is not None and self._answers.full is None:
                        self._show_case()  # in place of what was drawn while it was dragged
                        self._answers.spawn(self._answer(rest=True))
        finally:
            self._working = False

    async def _do(self, message: Message) -> None:
        work = getattr(self, f"_do_{message['do']}", None)
        if work is None:
            raise Refused([("", f"there is nothing to do that is called {message['do']}")])
        if self._opened is None and message["do"] != "open":
            raise Refused([("", "there is no case yet: choose an example")])
        if self._answers.searching and message["do"] in CHANGING:
            raise Refused([("", "a search is on, and its drives are for the case as it is: stop it first")])
        await work(message)

    async def _do_open(self, message: Message) -> None:
        """Open an example."""
        self._opened, self._selected = open_example(str(message.get("name"))), "0"
        await self._stepped()

    async def _do_menu(self, message: Message) -> None:
        """Show the examples."""
        self._answers.send(_menu())

    async def _do_set(self, message: Message) -> None:
        """Change fields to texts."""
        case, changes = self._open.case, message.get("changes")
        if not isinstance(changes, dict) or not all(isinstance(text, str) for text in changes.values()):
            raise Refused([("", "changes must map fields to texts")])
        wanted: dict[str, Any] = {}
        for path, text in changes.items():
            if not allowed(case, path):
                raise Refused([(path, "must be a field that the page has")])
            try:
                wanted |= changes_of(case, path, text)
            except ValueError as error:
                raise Refused([(path, str(error))]) from None
        self._open.change(await self._lanes.run(self._lanes.quick, case.vary, wanted), message.get("gesture"))
        self._answers.forget()
        rest = bool(message.get("rest"))
        await self._answer(rest, message.get("turn"))
        if rest:
            self._open.gesture = None
            self._show_case()

    async def _do_select(self, message: Message) -> None:
        """Show the fields of an actuator, or of all."""
        chosen, count = str(message.get("actuator")), len(self._open.case.actuators)
        if chosen != ALL and not (chosen.isdecimal() and int(chosen) < count):
            raise Refused([("", f"actuator must be a number below {count}, or {ALL} for all; got {chosen}")])
        self._selected = chosen
        self._show_case()

    async def _do_undo(self, message: Message) -> None:
        if self._open.undo():
            await self._stepped()

    async def _do_redo(self, message: Message) -> None:
        if self._open.redo():
            await self._stepped()

    async def _do_back(self, message: Message) -> None:
        """Go back to the case as it is saved, a step like any other."""
        self._open.change(self._open.saved, None)
        await self._stepped()

    async def _do_save(self, message: Message) -> None:
        name = message.get("name")
        if not isinstance(name, str):
            raise Refused([("", 'the name must be that of a file, such as "my_case.toml"')])
        selected = None if self._selected == ALL else self._open.case.actuators[int(self._selected) :][:1]
        path = self._open.save(name, bool(message.get("replace")))
        if selected:  # which may have left a lattice, and so have another number
            places = [math.dist(one.position, selected[0].position) for one in self._open.case.actuators]
            self._selected = str(places.index(min(places)))
        self._answers.send({"kind": "note", "text": f"Saved {path}"})
        await self._stepped()

    async def _do_picture(self, message: Message) -> None:
        if self._answers.full is None:
            raise Refused([("", "there is no run yet to draw")])
        data = await self._lanes.run(self._lanes.full, _picture, self._answers.full)
        self._answers.send({"kind": "picture", "name": f"{self._open.case.name}.png", "bytes": data})

    async def _do_drift(self, message: Message) -> None:
        """Find where parts go from everywhere, or no more."""
        self._answers.spawn(self._answers.drift(self._open.case, message.get("on") is True))

    async def _do_aim(self, message: Message) -> None:
        """Search for drives to a target, in m, within settings."""
        target = message.get("target")
        numbers = isinstance(target, list) and len(target) == 2 and all(type(c) in (int, float) for c in target)
        if not isinstance(target, list) or not numbers or not all(math.isfinite(c) for c in target):
            raise Refused([("target", "must be two numbers, x and y in m")])
        given = message.get("settings", {})
        if not isinstance(given, dict) or not set(given) <= set(CHOSEN):
            raise Refused([("target", f"settings must be some of {', '.join(CHOSEN)}")])
        try:
            settings = Settings.model_validate(given)
        except InputError as error:
            raise Refused([("target", f"{field} {text}") for field, text in error.problems]) from None
        search = Search(self._open.case, (float(target[0]), float(target[1])), settings)
        self._answers.aim(search, self._take_drives)

    async def _do_stop(self, message: Message) -> None:
        """Stop the search."""
        self._answers.stop()

    def _take_drives(self, case: Case) -> None:
        self._open.change(case, None)
        self._answers.spawn(self._stepped())

    @property
    def _open(self) -> Opened:
        assert self._opened is not None
        return self._opened

    async def _stepped(self) -> None:
        """Show a case that came in place of another."""
        self._answers.forget()
        self._show_case()
        await self._answer(rest=True)

    async def _answer(self, rest: bool, page_turn: object = None) -> None:
        case = self._open.case
        await self._answers.answer(case, case is self._open.saved, rest, page_turn)

    def _show_case(self) -> None:
        opened, case = self._open, self._open.case
        if self._selected != ALL and int(self._selected) >= len(case.actuators):
            self._selected = "0"
        self._answers.send(
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
                "changed": case is not opened.saved,
            }
        )


def _menu() -> dict[str, Any]:
    """The examples, those within every bound of the model first."""
    examples = sorted(example_cases().items(), key=lambda item: (OUTSIDE in item[1], item[0] not in FIRST))
    return {"kind": "menu", "examples": [[name, about] for name, about in examples]}


def _picture(full: Full) -> str:
    """The picture of a run as base64 of a PNG file, the same that `run` writes."""
    drawing = io.BytesIO()
    full.result.plot().savefig(drawing, format="png", dpi=DOTS)
    return base64.b64encode(drawing.getvalue()).decode()
