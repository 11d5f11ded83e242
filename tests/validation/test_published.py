"""The page of published values shows what its command computes, and no row is off by more than its remark explains."""

import tomllib
from pathlib import Path

import pytest
from stretching_square import pressed_square

DOCS = Path(__file__).parents[2] / "docs"
TABLES = tomllib.loads((DOCS / "published.toml").read_text())["table"]
FURTHER = ("isogeometric", "analytical values", "FALCO's default", "Kilo-DM")
CASES = [
    pytest.param(
        table, id=table["title"], marks=[pytest.mark.slow] if any(x in table["title"] for x in FURTHER) else []
    )
    for table in TABLES
]


@pytest.mark.parametrize("table", CASES)
def test_the_page_shows_what_its_command_computes(table, monkeypatch):
    monkeypatch.syspath_prepend(str(DOCS))
    import scorecard

    assert "\n".join(scorecard.lines(table)).rstrip() in (DOCS / "validation.md").read_text()
    off = table.get("within", 1.1e-2 if "remark" in table else 5e-3)
    bound = {"abs": table["absolute"], "rel": 0.0} if "absolute" in table else {"rel": off}
    assert scorecard.ours(table) == pytest.approx(scorecard.published(table), **bound)


def test_the_closed_form_of_stick_slip_is_met(monkeypatch):
    monkeypatch.syspath_prepend(str(DOCS))
    import scorecard

    table = next(table for table in TABLES if table["title"] == "Stick-slip up a wall, closed form")
    assert scorecard.ours(table) == pytest.approx(scorecard.published(table), rel=2e-5)


def test_shorter_steps_of_the_published_scheme_come_nearer_to_located_impacts(monkeypatch):
    monkeypatch.syspath_prepend(str(DOCS))
    import scorecard_motion

    located = scorecard_motion.impacts(0.0)
    errors = [abs(scorecard_motion.impacts_in_steps(steps, 0.0) / located - 1) for steps in (64, 640, 6400)]
    assert errors[1] < errors[0] / 8 and errors[2] < errors[1] / 8
    assert errors[2] < 3e-3


def test_friction_that_bears_every_blow_keeps_a_point_in_place_by_both_schemes(monkeypatch):
    monkeypatch.syspath_prepend(str(DOCS))
    import scorecard_motion

    assert scorecard_motion.impacts(0.5) == pytest.approx(0.0, abs=1e-9)
    assert scorecard_motion.impacts_in_steps(64, 0.5) == pytest.approx(0.0, abs=1e-9)


def test_sides_that_slide_explain_a_fifth_of_what_levys_clamped_square_is_off_by():
    pressure = 402 / 16 * 12 * (1 - 0.316**2)  # q a^4 / (E t^4), a the side, to D t over the fourth power of its half
    held, sliding = (pressed_square(pressure, True, 0.316, 6, slides)[0] for slides in (False, True))
    assert (held, sliding) == pytest.approx((1.8560, 1.8641), abs=1e-4)
    assert (sliding - held) / (1.902 - held) == pytest.approx(0.18, abs=0.02)
