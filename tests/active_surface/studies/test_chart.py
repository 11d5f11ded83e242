"""Charts over frequency and stroke: made of borders that are known, read between their columns, and picked from."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from active_surface.studies.feasibility.chart import TOLERANCE, Column, make_chart
from active_surface.studies.feasibility.pick import _candidates, clearances, pick
from active_surface.studies.feasibility.pictures import AROUND, _ends
from active_surface.studies.feasibility.result import Feasibility
from common import draw
from particle import Outcome

STROKES = (1e-3, 16.0)


def charted(slips, lost, all_lost=None, first=0.25, last=8.0, count=11, most=40):
    """The chart of borders that are functions of the factor of frequency."""

    def find(k, beside):
        upper = lost(k) if all_lost is None else all_lost(k)
        return Column(k, slips(k), lost(k), upper)

    return make_chart(find, np.geomspace(first, last, count).tolist(), STROKES, most)


def bent(k):
    """A border that is no power of the frequency."""
    return 0.3 / k + 0.1 / k**2


def test_smooth_borders_hold_to_the_tolerance_between_columns():
    chart = charted(bent, lambda k: 1 / k + 0.2 / k**2 + 0.1 * math.sin(k))
    assert all(one.slips and one.losses for one in chart.smooth)
    for k in np.random.default_rng(1).uniform(0.25, 8.0, 200).tolist():
        limits = chart.limits(k)
        assert limits.slips[0] == limits.slips[1] == pytest.approx(bent(k), rel=TOLERANCE)
        assert limits.lost[0] == pytest.approx(1 / k + 0.2 / k**2 + 0.1 * math.sin(k), rel=TOLERANCE)


def test_a_jump_is_narrowed_and_what_lies_across_it_may_go_either_way():
    chart = charted(bent, lambda k: 2.0 if k < 1.7 else 4.0)
    around = [k for k in np.geomspace(0.25, 8.0, 4000).tolist() if chart.state(k, 3.0) == "either"]
    assert max(around) / min(around) < 1.02 and min(around) < 1.7 < 1.002 * max(around)
    assert (chart.state(1.0, 3.0), chart.state(3.0, 3.0)) == ("lost", "moves")


def test_ragged_borders_claim_nothing_between_them_and_take_no_columns():
    chart = charted(bent, lambda k: 1.0 + 0.3 * math.sin(40 * k), lambda k: 2.0 + 0.3 * math.sin(50 * k))
    ratios = [b.frequency / a.frequency for a, b in zip(chart.columns, chart.columns[1:], strict=False)]
    assert min(ratios) > 1.06 and chart.state(1.0, 1.5) == "either"
    assert chart.state(1.1, 2.6) == "lost" and chart.state(1.1, bent(1.1) * 0.99) == "rest"


def test_a_border_beyond_the_largest_stroke_has_no_points():
    chart = charted(lambda k: math.inf if k < 1 else 1.0, lambda k: math.inf)
    assert chart.state(0.3, 10.0) == "rest" and chart.state(7.0, 10.0) == "moves"
    with pytest.raises(ValueError, match="must be from 0.25 to 8 times the case's; got 9"):
        chart.limits(9.0)


def test_points_are_as_far_from_borders_as_geometry_says():
    """Between horizontal borders a factor of four apart the middle is a factor of two from both."""
    chart = charted(lambda k: 1.0, lambda k: 4.0)
    points, rooms = _candidates(chart, np.full(len(chart.columns), np.inf))
    assert rooms.max() == pytest.approx(math.log(2), rel=1e-3)
    assert clearances(chart, np.array([[1.0, 3.0]]))[0] == pytest.approx(math.log(4 / 3), rel=1e-3)
    assert points[:, 1].min() > 1 and points[:, 1].max() < 4
    assert len(_candidates(chart, np.full(len(chart.columns), 0.9))[0]) == 0


def found_of(chart, **ground):
    """A feasibility with a chart, of a case at 300 Hz and 10 um whose model is valid up to twice that."""
    case, ground = SimpleNamespace(name="case"), SimpleNamespace(duration=0.01, linear=True, **ground)
    valid = np.full(len(chart.columns), 2.0)
    return Feasibility(case, "moves", chart, valid, None, None, 300.0, 1e-5, "m", 0.01, ground)


@pytest.mark.parametrize(("strokes", "unknown"), [((0.5, 4.0), False), ((1.2, 4.0), True), ((0.5, 0.9), True)])
def test_the_picture_shows_nothing_as_known_that_was_not_looked_at(strokes, unknown):
    """Losses begin beyond the largest stroke at low frequencies; slip jumps between the two highest."""

    def find(k, beside):
        lost = 6 / k if 6 / k <= strokes[1] else math.inf
        return Column(k, strokes[0] if k < 2 else 0.8 * strokes[1], lost, lost)

    axes = draw(found_of(make_chart(find, [0.5, 1.0, 2.0], strokes, 3))).axes[0]
    labels = [text.get_text() for text in axes.get_legend().get_texts()]
    assert ("not looked at" in labels) == unknown and "undecided" in labels
    assert axes.get_ylim() == pytest.approx((10 * min(strokes[0], 1.0), 10 * max(strokes[1], 1.2)))
    greys = [patch.get_extents().transformed(axes.transData.inverted()) for patch in axes.patches]
    assert [ends for box in greys for ends in (box.y0, box.y1)][1:3] == pytest.approx(
        [10 * s for s in strokes] * unknown
    )
    hatched = next(band.get_paths()[0].get_extents() for band in axes.collections if band.get_hatch() == "////")
    assert (hatched.y0, hatched.y1) == pytest.approx((10 * strokes[0], 8 * strokes[1]))
    assert any(line.get_linestyle() == "--" for line in axes.lines) == any("beyond" in label for label in labels)


def test_a_point_that_carries_the_part_too_short_a_way_is_refused_with_the_least_distance(monkeypatch):
    """The best of those tried, too, which is no proof that no other does."""
    path = SimpleNamespace(outcome=Outcome.MOVING, distance=1.21e-6)
    ground = {"surface": SimpleNamespace(size=2e-3), "paths": lambda points, threads: [path] * len(points)}
    monkeypatch.setitem(
        pick.__globals__, "run_case", lambda case, progress: SimpleNamespace(trajectory=path, summary=path)
    )
    monkeypatch.setattr(Feasibility, "at", lambda *_: None)
    found = found_of(charted(lambda k: 1.0, lambda k: 4.0), **ground)
    least = "must carry the part farther than 2 µm, 0.001 of half the plate's longer side, without losing it; got "
    ends = ", where it moves only 1.21 µm: at that frequency it slips from 10 µm and is lost from 40 µm"
    with pytest.raises(ValueError, match=f"^Input pick of feasibility {least}400 Hz and 20 µm{ends}$"):
        pick(found, 400.0, 2e-5)
    with pytest.raises(ValueError, match=rf"{least}the best of \d+ points, .* µm{ends}$"):
        pick(found)
    narrow = found_of(charted(lambda k: 1.0, lambda k: 1.01), **ground)
    with pytest.raises(ValueError, match="; at every .* that loses it is less than 1.02 times the one that moves it$"):
        pick(narrow)
    with pytest.raises(ValueError, match="part moves without being lost; no stroke looked at moves it$"):
        pick(found_of(charted(lambda k: math.inf, lambda k: math.inf), **ground))


def test_the_drawn_chart_ends_at_the_least_stroke_that_was_looked_at_or_at_the_case():
    columns = np.array([[2.0, 8.0], [2.0, np.inf]])
    assert _ends(columns, 4.0, np.array([1.5, 32.0])) == pytest.approx((1.5, 8 * AROUND))
    assert _ends(columns, 1.0, np.array([1.5, 32.0])) == pytest.approx((1.0, 8 * AROUND))
    assert _ends(columns, 4.0, np.array([0.1, 32.0]))[0] == pytest.approx(2 / AROUND)
    assert [_ends(columns, own, np.array([0.1, 10.0]))[1] for own in (4.0, 12.0)] == pytest.approx([10.0, 14.4])
