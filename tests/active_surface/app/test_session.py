"""A tab without a browser: messages of the page, and what it gets for them."""

import asyncio
import base64
from itertools import count

import numpy as np
import pytest
from app_case import CASE

from active_surface.app.answers import ACROSS, Lanes
from active_surface.app.opened import MAX_STEPS, open_case
from active_surface.app.session import Session
from active_surface.studies.drifts import Fate, drift
from coupling import read_case, run_case

pytestmark = pytest.mark.compiled


class Page:
    """What a page sends and gets."""

    def __init__(self, path):
        self.lanes, self.got, self._turns = Lanes(), [], count(1)
        self.session = Session(self.lanes, None if path is None else open_case(path))

    async def __aenter__(self):
        self.session.connect(self.got.append)
        return self

    async def __aexit__(self, *_):
        self.session.close()
        self.lanes.close()

    async def wait(self, kind, after=0):
        for _ in range(6000):
            if found := [one for one in self.got[after:] if one["kind"] == kind]:
                return found[0]
            await asyncio.sleep(0.01)
        raise AssertionError(f"{kind} did not come, but {[one['kind'] for one in self.got]}")

    async def do(self, kind, **message):
        after = len(self.got)
        self.session.take(message)
        return await self.wait(kind, after)

    async def set(self, kind, rest=True, gesture=None, **changes):
        changes = {path.replace("__", "."): text for path, text in changes.items()}
        turn = next(self._turns)
        return await self.do(kind, do="set", turn=turn, gesture=gesture or turn, changes=changes, rest=rest)


@pytest.fixture
def path(tmp_path):
    (tmp_path / "mine.toml").write_text(CASE)
    return tmp_path / "mine.toml"


def ends(page):
    return page.session._answers._search.settings.frequency


def floats(packed):
    return np.frombuffer(base64.b64decode(packed["bytes"]), "<f4")


def case_of(page):
    return page.session._open.case


@pytest.mark.slow
def test_what_is_shown_is_what_a_run_of_the_saved_case_gives(path):
    async def work():
        async with Page(path) as page:
            first = await page.wait("run")
            assert first["saved"]
            shown = await page.set("run", actuators__0__frequency="1.1 kHz", part__position__0="70 um")
            assert not shown["saved"]
            await page.do("note", do="save", name="yours", replace=False)
            return shown

    shown = asyncio.run(work())
    saved = path.with_name("yours.toml")
    summary = run_case(read_case(saved)).summary
    assert shown["figures"] == {
        "distance": summary.distance, "end": summary.end_position, "outcome": summary.outcome
    }  # fmt: skip
    expected = CASE.replace('"900 Hz"', '"1100 Hz"').replace('"80 um", "30 um"', '"70 um", "30 um"')
    assert saved.read_text() == expected  # comments and order stay
    assert path.read_text() == CASE


def test_mistakes_are_at_their_fields_in_the_words_of_check_and_change_nothing(path):
    async def work():
        async with Page(path) as page:
            wrong = await page.set("refused", actuators__0__frequency="12 mm")
            message = "must be a frequency such as 300 Hz; got 12 mm, a length"  # as it is typed
            assert wrong["mistakes"] == [{"field": "actuators[0].frequency", "message": message}]
            for text, got in (("0.1 um", "0.1 um"), ("0,3", "0,3"), ('"0.3"', '"0.3"'), ("", "nothing")):
                plain = await page.set("refused", plate__poisson_ratio=text)
                message = f"must be a number such as 0.3, without a unit; got {got}"
                assert plain["mistakes"] == [{"field": "plate.poisson_ratio", "message": message}]
            off = await page.set("refused", part__position__0="400 um")
            assert "inside the rim" in off["mistakes"][0]["message"] or "must" in off["mistakes"][0]["message"]
            barred = await page.set("refused", friction__file="/etc/passwd")
            assert barred["mistakes"] == [{"field": "friction.file", "message": "must be a field that the page has"}]
            assert case_of(page) is page.session._open.saved

    asyncio.run(work())


NONSENSE = [
    *(None, 3, [], {"do": 4}, {"do": "fly"}, {"do": "open", "name": "../x"}, {"do": "menu", "turn": 1e400}),
    *({"do": "set"}, {"do": "set", "changes": [1]}, {"do": "set", "changes": {"a": 1}}),
    *({"do": "select", "actuator": "9"}, {"do": "select"}),
    *({"do": "save", "name": name} for name in (None, "../x.toml", "/tmp/x.toml", ".toml", "x.txt")),
    *({"do": "aim", "target": target} for target in (None, [1e400, 0], [True, 0], [1.0, 1.0])),
    *(
        {"do": "aim", "target": [1e-5, 0], "settings": settings}
        for settings in (
            3,
            {"paths": 3},
            {"groups": "some"},
            {"stroke": ["", "9 um"]},
            {"frequency": ["2 kHz", "1 kHz"]},
        )
    ),
]


def test_nonsense_is_refused(path):
    async def work():
        async with Page(path) as page:
            await page.wait("case")
            for message in NONSENSE:
                after = len(page.got)
                page.session.take(message)
                refused = await page.wait("refused", after)
                assert refused["mistakes"][0]["message"]
                assert case_of(page) is page.session._open.saved

    asyncio.run(work())
    assert sorted(file.name for file in path.parent.iterdir()) == ["mine.toml"]


@pytest.mark.slow
def test_a_drag_is_one_step_to_undo(path):
    async def work():
        async with Page(path) as page:
            await page.wait("run")
            for k in range(5):
                await page.set("path", rest=k == 4, gesture=7, actuators__0__stroke=f"{50 - k} um")
            await page.set("run", part__mass="3e-9 kg")
            assert len(page.session._open.steps) == 2
            shown = await page.do("case", do="undo")
            assert case_of(page).part.mass == 2e-9 and shown["redo"] == 1
            await page.do("case", do="undo")
            assert case_of(page).actuators[0].stroke == pytest.approx(60e-6)
            await page.do("case", do="redo")
            assert case_of(page).actuators[0].stroke == pytest.approx(46e-6)
            back = await page.do("run", do="back")
            assert back["saved"] and not (await page.do("case", do="select", actuator="*"))["changed"]

    asyncio.run(work())


def test_steps_to_undo_are_limited(path):
    opened = open_case(path)
    for k in range(MAX_STEPS + 20):
        opened.change(opened.case.vary({"part.mass": 1e-9 * (1 + k)}), k)
    assert len(opened.steps) == MAX_STEPS
    while opened.undo():
        pass
    assert opened.case.part.mass == pytest.approx(20e-9)


@pytest.mark.slow
def test_a_file_is_replaced_only_where_that_is_asked_for(path):
    async def work():
        async with Page(path) as page:
            await page.wait("run")
            await page.set("run", part__mass="3e-9 kg")
            refused = await page.do("refused", do="save", name="mine.toml", replace=False)
            assert "exists; replace it" in refused["mistakes"][0]["message"]
            for name, wrong in (("x" * 300, "must have a name of at most 200 bytes"), ("a\x1b", "got U+001B in it")):
                refused = await page.do("refused", do="save", name=name, replace=False)
                assert refused["mistakes"][0]["message"].startswith("the file must have a name") and wrong in str(
                    refused
                )
            assert path.read_text() == CASE
            await page.do("note", do="save", name="mine.toml", replace=True)

    asyncio.run(work())
    assert path.read_text() == CASE.replace('"2e-9 kg"', '"3e-9 kg"')


def test_an_example_is_opened_from_the_menu_and_saved_where_the_program_was_started(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)

    async def work():
        async with Page(None) as page:
            menu = await page.wait("menu")
            assert "two_actuators" in dict(menu["examples"])
            await page.do("refused", do="undo")
            shown = await page.do("case", do="open", name="two_actuators")
            assert shown["file"] is None and shown["folder"] == str(tmp_path)
            await page.do("note", do="save", name="mine.toml", replace=False)

    asyncio.run(work())
    assert read_case(tmp_path / "mine.toml").actuators[1].frequency == 300.0


def test_what_was_not_changed_is_saved_as_it_stood_and_who_leaves_a_lattice_stays_selected(path):
    lattice = '[lattice]\nrows = 1\ncolumns = 3\npitch = "0.1 mm"  # apart\nstroke = "60 um"\nfrequency = "0.9 kHz"\n'
    actuators = CASE[CASE.index("[[actuators]]") : CASE.index("[part]")]
    text = CASE.replace(actuators, lattice + "\n")
    path.write_text(text)

    async def work():
        async with Page(path) as page:
            await page.wait("case")
            await page.do("case", do="select", actuator="2")
            await page.set("case", actuators__2__position__1="-20 um", actuators__2__frequency="1 kHz")
            await page.do("note", do="save", name="yours", replace=False)
            assert case_of(page).actuators[int(page.session._selected)].position == (1e-4, -2e-5)

    asyncio.run(work())
    own = '[[actuators]]\nposition = ["0.1 mm", "-0.02 mm"]\nstroke = "60 um"\nfrequency = "1 kHz"\n'
    expected = text.replace(lattice, f'{lattice}where = "column != 2"\n\n{own}')
    assert path.with_name("yours.toml").read_text() == expected


@pytest.mark.slow
def test_a_picture_is_a_png(path):
    async def work():
        async with Page(path) as page:
            await page.wait("run")
            return await page.do("picture", do="picture")

    picture = asyncio.run(work())
    assert picture["name"] == "mine.png" and picture["bytes"].startswith("iVBORw0KGgo")


@pytest.mark.slow
def test_a_search_is_watched_stopped_and_its_drives_taken(path):
    async def work():
        async with Page(path) as page:
            await page.wait("run")
            settings = {"groups": "all", "frequency": ["850 Hz", "950 Hz"]}
            page.session.take({"do": "aim", "target": [70e-6, 26e-6], "settings": settings})
            assert (await page.wait("search"))["left"] >= 0
            assert (page.session._answers._search.settings.groups, ends(page)) == ("all", (850.0, 950.0))
            for other in (
                {"do": "aim", "target": [1e-5, 0]},
                {"do": "set", "changes": {"part.mass": "1 ug"}},
                {"do": "undo"},
            ):
                busy = await page.do("refused", **other)
                assert "stop it first" in busy["mistakes"][0]["message"]
            page.session.take({"do": "stop"})
            found = await page.wait("found")
            assert "from the target" in found["text"]
            await page.wait("search")
            if "yours stay" not in found["text"]:
                await page.wait("case", page.got.index(found))
            assert len(page.session._open.steps) == ("yours stay" not in found["text"])

    asyncio.run(work())


@pytest.mark.slow
def test_two_tabs_do_not_disturb_each_other(path):
    async def work():
        async with Page(path) as one:
            other = Session(one.lanes, open_case(path))
            got = []
            other.connect(got.append)
            await one.set("run", part__mass="3e-9 kg")
            assert case_of(one).part.mass == 3e-9 and other._open.case.part.mass == 2e-9
            assert all(message["kind"] in ("case", "path", "run", "busy", "idle") for message in got)
            other.close()

    asyncio.run(work())


def test_where_parts_go_is_found_until_the_case_changes_or_nobody_wants_it(path):
    async def watch():
        async with Page(path) as page:
            await page.wait("run")
            before = len(page.got)
            for on in (True, False):  # before it has begun
                page.session.take({"do": "drift", "on": on})
            await page.wait("idle", before)
            shown = await page.do("drift", do="drift", on=True)
            assert len([one for one in page.got if one["kind"] == "drift"]) == 1
            found = drift(case_of(page), across=ACROSS).maps[0]
            arrows = floats(shown["arrows"]).reshape(-1, 2, 2)
            moves = found.fates == Fate.MOVES
            assert moves.any() and not moves.all()
            np.testing.assert_allclose(arrows.mean(axis=1), 1e6 * found.starts[moves], rtol=1e-4, atol=1e-2)
            ways = arrows[:, 1] - arrows[:, 0]
            assert ((ways * found.moved[moves]).sum(axis=1) > 0).all()
            assert (len(floats(shown["still"])) / 2, len(floats(shown["lost"])) / 2) == (
                (found.fates == Fate.STAYS).sum(),
                (found.fates > Fate.MOVES).sum(),
            )
            page.session.take({"do": "drift", "on": True})
            await page.set("run", actuators__0__stroke="50 um")
            assert len([one for one in page.got if one["kind"] == "drift"]) == 1

    asyncio.run(watch())
