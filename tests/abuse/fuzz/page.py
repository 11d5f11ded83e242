"""Messages of a page to the app: made by grammar, and taken by a session in this process."""

from __future__ import annotations

import asyncio
import json
import random
import time
from pathlib import Path
from typing import Any, Final

from fuzz import seeds
from fuzz.mutations import NUMBERS, WORDS, mutated_text, quantity

FIELDS: Final = (
    *("actuators.0.stroke", "actuators.0.frequency", "actuators.0.position.0", "actuators.*.stroke", "part.mass"),
    *("part.position.1", "friction.coefficient", "friction.adhesion", "plate.radius", "plate.thickness"),
    *("run.duration", "run.frames", "plate.shape", "friction", "actuators", "__class__", "", "actuators.9.stroke"),
)
RIGHT: Final = ("3 um", "2 kHz", "10 um", "1 um", "1 ug", "0 um", "0.4", "10 nN", "310 um", "6 um", "2 ms", "4")
NAMES: Final = ("out.toml", "quick.toml", "out", "../out.toml", "/tmp/out.toml", ".toml", "a/b.toml", "con.toml", "\0")
RESTING: Final = 2.0  # s that work goes on after the last message


def messages(chance: random.Random, _: Path) -> list[str]:
    """Messages, a line each, to a page with a case."""
    Path("input.toml").write_text(seeds.QUICK)
    lines = [json.dumps(_message(chance)) for _ in range(chance.choice((1, 2, 4, 8)))]
    if chance.random() < 0.2:
        lines = mutated_text("\n".join(lines), chance).replace("\r", "\n").split("\n")
    Path("messages.jsonl").write_bytes("\n".join(lines).encode("utf-8", "surrogatepass"))
    return ["messages", "input.toml", "messages.jsonl"]


def _message(chance: random.Random) -> Any:
    what = chance.choice(("set", "set", "set", "set", "undo", "redo", "back", "save", "open", "menu", "select", "aim"))
    what = chance.choice((what, what, what, what, what, "picture", "stop", "wrong", "__init__", ""))
    strange = chance.choice((None, 1, [], {}, "text", True, 1e300, [1, 2], {"a": {}}))
    texts = (*RIGHT, *RIGHT, quantity(chance), chance.choice(NUMBERS), chance.choice(WORDS), strange)
    changes = {chance.choice(FIELDS): chance.choice(texts) for _ in range(chance.choice((1, 1, 2)))}
    message: dict[str, Any] = {
        "do": what,
        "changes": changes,
        "rest": chance.random() < 0.4,
        "gesture": chance.choice(("a", "b", None)),
        "turn": chance.choice((1, 2, 3)),
        "name": chance.choice((*NAMES, *WORDS)),
        "replace": chance.random() < 0.5,
        "actuator": chance.choice(("0", "*", "all", "9", -1)),
        "target": chance.choice(([50e-6, 20e-6], [0, 0], [1, 1], [True, None])),
    }
    if chance.random() < 0.1:
        message[chance.choice(list(message))] = strange
    if chance.random() < 0.1:
        del message[chance.choice(list(message))]
    return strange if chance.random() < 0.02 else message


def taken(case: str, path: str) -> tuple[str, int, str]:
    """What was wrong with how a session took the messages of a file, its code (2: some were refused), and answers."""
    from active_surface.app import Lanes, Session, open_case

    sent: list[dict[str, Any]] = []

    async def work() -> None:
        lanes = Lanes()
        session = Session(lanes, open_case(Path(case)))
        try:
            await said(session)
        finally:  # after a time-out, too
            session.close()
            lanes.close()

    async def said(session: Session) -> None:
        session.connect(sent.append)
        for line in Path(path).read_bytes().split(b"\n"):
            try:
                session.take(json.loads(line))
            except ValueError:
                session.take(None)
            await asyncio.sleep(0.002)
        answers, end = session._answers, time.monotonic() + RESTING
        while answers._tasks and (answers.searching or time.monotonic() < end):
            await asyncio.sleep(0.01)
            if time.monotonic() > end:
                answers.stop()
        session.close()
        while answers._tasks:  # what nobody waits for any more must end by itself
            await asyncio.sleep(0.01)

    asyncio.run(work())
    json.dumps(sent, allow_nan=False)
    failed = next((str(one["text"]) for one in sent if one["kind"] == "trouble"), "")
    if failed:
        return f"the page says {failed[:80]}", 0, ""
    refused = [one for one in sent if one["kind"] == "refused"]
    return "", 2 if refused else 0, json.dumps(refused)
