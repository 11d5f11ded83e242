"""Feasible areas: against the radial integral of a disc, and drives that really run faster."""

import json

import numpy as np
import pytest
from click.testing import CliRunner
from sweeps import PLATE

from active_surface.cli.program import main
from active_surface.studies.feasibility import area
from active_surface.studies.feasibility.area import Curves, find_feasible
from active_surface.studies.feasibility.case import feasibility
from active_surface.studies.feasibility.chart import Chart
from active_surface.studies.feasibility.pick import pick
from active_surface.studies.feasibility.places import squares_within
from active_surface.studies.feasibility.report import lines, warnings
from common import quantity_text
from coupling import build_friction, build_surface, follow_part, read_case, run_case, surface_motion
from coupling.case import write_case
from fem_plate.analytic import DiscShapes
from particle import (
    ConstantFriction,
    CoulombAdhesion,
    Drive,
    HermiteDrive,
    KogutEtsion,
    Micropart,
    Outcome,
    Segment,
    SegmentDrive,
    TableDrive,
    polynomial_surface,
    simulate,
)

RADIUS, STROKE, MASS, GRAVITY = 300e-6, 150e-6, 2e-9, 9.80665
SHAPES = DiscShapes([[0.0, 0.0]], RADIUS)
CASE = "examples/one_actuator.toml"
SHORT = {"run.duration": "7 ms"}
PART = Micropart(MASS, (0.0, 0.0))


def radial(frequency, law):
    """Areas of an up-down drive by rings: feasible, slipping and lost, at most [m^2] and over time [m^2 s]."""
    r = (np.arange(800) + 0.5) / 800
    ring = 2 * np.pi * r * RADIUS**2 / 800
    phi, slope = 1 - r**2 + 2 * r**2 * np.log(r), 4 * r * np.log(r) / RADIUS
    half = 0.5 / frequency
    s = (np.arange(3000) + 0.5) / 3000
    rise, pull = 10 * s**3 - 15 * s**4 + 6 * s**5, 60 * s - 180 * s**2 + 120 * s**3
    h = STROKE * np.concatenate([rise, 1 - rise])[:, None]
    a = STROKE / half**2 * np.concatenate([pull, -pull])[:, None]
    b, g = GRAVITY + a * phi, h * slope
    load = MASS * b / np.sqrt(1 + g**2)
    held = (load >= -law.pull_off) & (load <= law.law.largest_load)
    limit = law.law.static_ratio * law.friction_limit(np.clip(load, -law.pull_off, law.law.largest_load))
    slips = held & (MASS * np.abs(b * g) / np.sqrt(1 + g**2) > limit)
    lost = ~held.all(axis=0)
    areas, every = (slips & ~lost) @ ring, slips @ ring
    return areas.max(), areas.mean() / frequency, every.max(), every.mean() / frequency, lost @ ring


LAWS = {
    "kogut-etsion": KogutEtsion.paper(),
    "coulomb": CoulombAdhesion(0.3, 5e-8, 0.36),
    "constant": ConstantFriction(3e-8),
}


@pytest.mark.compiled
@pytest.mark.parametrize("name", [*(pytest.param(n, marks=pytest.mark.slow) for n in list(LAWS)[:2]), "constant"])
def test_areas_are_those_of_the_radial_integral(name):
    """Also at eight times the frequency of moments that are chosen for it, where slips are much shorter."""
    law, frequency, factors = LAWS[name], 250.0, np.array([1.0, 4.0, 8.0])
    surface = surface_motion(SHAPES, [Drive(STROKE, frequency)])
    found = find_feasible(surface, SHAPES.outline, PART, law, 1 / frequency, factors, GRAVITY)
    errors, most = found.errors, 2 * area.PER_STROKE * 2**area.MAX_HALVINGS
    assert max(errors) <= 0.01 or (name == "coulomb" and found.count == most and max(errors) < 0.15)
    truth = np.array([radial(factor * frequency, law) for factor in factors.tolist()]).T  # (5, F)
    curves = np.array([*found.feasible, *found.slipping, found.lost_area])
    # Of Coulomb's law a ring of 0.7 um stays at the rim at 2 kHz, which the errors state to a factor of two.
    bound = np.maximum(0.01, [[2 * errors.squares]] * 2 + [[errors.moments], [0.01], [0.01]])
    assert (np.abs(curves - truth) <= bound * np.maximum(truth, 0.05 * truth.max(axis=1, keepdims=True))).all()
    assert (found.lost_area > 0).tolist() == [name == "coulomb", name != "constant", name != "constant"]
    assert [found.own.peak, found.own.integral] == [found.feasible.peak[0], found.feasible.integral[0]]


@pytest.mark.slow
@pytest.mark.compiled
def test_areas_of_an_array_hold_against_twenty_times_the_moments(monkeypatch):
    places = [(x, y) for x in (-1e-4, 1e-4) for y in (-8e-5, 8e-5)]
    shapes = DiscShapes(places, RADIUS)
    drives = [Drive(4e-5 - 5e-6 * k, 300.0 + 100.0 * (k % 2), delay=2e-4 * k) for k in range(4)]
    surface = surface_motion(shapes, drives)

    def find():
        factors = np.array([1.0, 8.0])
        return find_feasible(surface, shapes.outline, PART, LAWS["coulomb"], 6e-3, factors, GRAVITY, 24)

    mine = find()
    for name, value in (("PER_STROKE", 480), ("MAX_HALVINGS", 1), ("TOLERANCE", np.inf)):
        monkeypatch.setattr(area, name, value)
    fine = find()
    assert fine.count == 480 * 6e-3 * 800 > 2 * mine.count
    for curves in ("slipping", "feasible"):
        for name in Curves._fields:
            a, b = getattr(getattr(mine, curves), name), getattr(getattr(fine, curves), name)
            place = mine.spacing**2 if name == "peak" else 0.0  # areas are whole squares
            assert a == pytest.approx(b, rel=0.01, abs=0.005 * b.max() + place)
    assert mine.lost_area == pytest.approx(fine.lost_area, rel=0.01)


@pytest.mark.slow
@pytest.mark.compiled
def test_a_factor_is_a_drive_that_runs_so_much_faster():
    law = KogutEtsion.paper()
    both = []
    for speed, factor in ((1.0, 2.5), (2.5, 1.0)):
        segments = Segment(STROKE, 200.0 * speed, dwell=1e-4 / speed), Segment(STROKE / 2, 300.0 * speed)
        surface = surface_motion(SHAPES, [SegmentDrive(segments, delay=1e-3 / speed)])
        found = find_feasible(surface, SHAPES.outline, PART, law, 1 / (200 * speed), np.array([factor]), GRAVITY, 40)
        assert found.factors.tolist() == [factor] and found.slipping.peak[0] > 0
        both.append([found.feasible.peak[0], found.feasible.integral[0], found.slipping.peak[0]])
    assert both[0] == pytest.approx(both[1], rel=0.01)  # moments are chosen for all factors together


FIRST, SECOND = 'stroke = "60 um"\nfrequency = "400 Hz"\n', 'stroke = "60 um"\nfrequency = "300 Hz"\n'
REST = 'stroke = "0 um"\nfrequency = "100 kHz"\n'
PART_OF = '[[actuators.segments]]\nstroke = "{}"\nfrequency = "{}"\n'


@pytest.mark.compiled
@pytest.mark.parametrize(
    ("drives", "frequency", "whole"),
    [
        ((FIRST, REST), 400, 2.5e-3),
        *(
            pytest.param(*one, marks=pytest.mark.slow)
            for one in (
                ((FIRST, PART_OF.format("20 um", "3 kHz")), 3000, 1 / 3000 + 2.5e-3),
                ((REST, PART_OF.format("20 um", "250 Hz") + PART_OF.format("9 um", "500 Hz")), 500, 5e-3),
                ((REST, 'table = [["0 ms", "0 um"], ["1 ms", "9 um"], ["3 ms", "0 um"]]\n'), 500, 3e-3),
            )
        ),
    ],
)
def test_the_fastest_drive_is_one_that_moves_of_any_kind(tmp_path, monkeypatch, drives, frequency, whole):
    """It sets the frequencies, and how long areas are looked at; the map plays no part in that."""
    room = "active_surface.studies.feasibility.case."
    monkeypatch.setattr(room + "_chart", lambda *_: Chart((), (0.1, 10.0), ()))
    for name in ("valid_strokes", "nearest"):
        monkeypatch.setattr(room + name, lambda *_: None)
    text = PLATE.replace(FIRST, "FIRST").replace(SECOND, drives[1]).replace("FIRST", drives[0])
    (tmp_path / "base.toml").write_text(text)
    found = feasibility(read_case(tmp_path / "base.toml"), across=10, areas=True)
    assert found.frequency == pytest.approx(frequency) and found.areas.factors[0] == pytest.approx(0.25)
    assert found.whole_window == found.areas.window == pytest.approx(whole)
    strokes = 2 * frequency * whole
    assert found.areas.count / strokes == pytest.approx(24, rel=0.02) or found.areas.count / strokes > 47


def test_drives_of_which_none_moves_are_refused(tmp_path):
    (tmp_path / "base.toml").write_text(PLATE.replace('"60 um"', '"0 um"'))
    with pytest.raises(ValueError, match="^Input case of feasibility must have a drive that moves; got none$"):
        feasibility(read_case(tmp_path / "base.toml"))


def test_nothing_is_lost_without_pull_off_and_nothing_moves_where_friction_holds():
    surface = surface_motion(SHAPES, [Drive(STROKE, 2000.0)])
    loose, held = (
        find_feasible(surface, SHAPES.outline, PART, ConstantFriction(limit), 5e-4, np.ones(1), GRAVITY, 10)
        for limit in (1e-12, 1.0)
    )
    assert not loose.own.lost.any() and loose.feasible.peak[0] > 0
    assert held.slipping.peak[0] == held.feasible.integral[0] == held.own.shares.max() == 0


def test_a_tilt_alone_makes_a_part_slip():
    surface = surface_motion(SHAPES, [Drive(0.0, 100.0)])
    for tilt, moves in ((6.0, True), (4.0, False)):
        found = find_feasible(
            surface, SHAPES.outline, PART, ConstantFriction(5 * MASS), 1e-2, np.ones(1), (tilt, 0.0, -8.0), 8
        )
        assert found.own.shares.all() == found.own.shares.any() == moves


@pytest.mark.parametrize("moves", [True, False])
def test_a_base_that_shakes_makes_a_part_slip_as_the_integrator_says(moves):
    """Level ground that goes 1 mm to the side in 10 ms: friction bears its hardest acceleration or does not."""
    base = TableDrive([0.0, 1e-2], [0.0, 1e-3]), TableDrive([0.0, 1e-2], [0.0, 0.0])
    surface = polynomial_surface([[0.0]], base)
    hardest = float(np.abs(base[0].evaluate(np.linspace(0, 1e-2, 1001))[2]).max())
    law = ConstantFriction((0.9 if moves else 1.1) * hardest * MASS)
    found = find_feasible(surface, SHAPES.outline, PART, law, 1e-2, np.array([0.5, 2.0]), GRAVITY, 10)
    assert found.own.shares.all() == found.own.shares.any() == moves
    assert (found.slipping.peak > 0).tolist() == [False, True]
    assert (simulate(surface, PART, law, 1e-2).path_length > 0) == moves


def test_a_base_that_shakes_a_slope_lifts_the_part():
    """w = x: pushed towards +x the slope falls away from under the part, at b.grad(w) > g."""
    for acceleration, lost in ((9.7, False), (9.9, True)):
        base = HermiteDrive.of(lambda t, a=acceleration: (a * t**2 / 2, a * t, a + 0 * t), 1e-2, 4)
        still = TableDrive([0.0, 1e-2], [0.0, 0.0])
        surface = polynomial_surface([[0.0], [1.0]], (base, still))
        law = CoulombAdhesion(0.5, 0.0)
        found = find_feasible(surface, SHAPES.outline, PART, law, 1e-2, np.ones(1), GRAVITY, 10)
        assert found.own.lost.all() == found.own.lost.any() == lost
        outcome = simulate(surface, PART, law, 1e-2).outcome
        assert (outcome is Outcome.DETACHED) == lost


@pytest.mark.slow
@pytest.mark.compiled
def test_a_long_window_is_cut_and_the_rest_of_it_is_not_hidden():
    surface = surface_motion(SHAPES, [Drive(STROKE, 400.0)])
    found = find_feasible(surface, SHAPES.outline, PART, ConstantFriction(MASS), 1.0, np.ones(1), GRAVITY, 10)
    assert found.window == pytest.approx(85 / 800) and found.count in [85 * 24 * 2**k for k in range(4)]
    figures = {"window": found.window, "whole_window": 1.0, "areas_change_by": 0.0, "areas_differ_by_squares": 0.0}
    figures |= {"duration": 1.0, "whole_duration": 1.0}
    figures["map"] = {"frequencies": [], "lost_from": [], "all_lost_from": []}
    assert "first 106.2 ms" in warnings(figures)[0] and warnings(figures | {"whole_window": found.window}) == []
    assert "Areas are good to 3 %" in warnings(figures | {"areas_differ_by_squares": 0.03})[1]


def test_squares_fill_the_plate_and_know_their_neighbours():
    points, side, neighbours = squares_within(SHAPES.outline, 100)
    assert len(points) * side**2 == pytest.approx(np.pi * RADIUS**2, rel=0.01)
    assert (np.hypot(*points.T) < RADIUS).all()
    for k, step in enumerate(side * np.array([(-1, 0), (1, 0), (0, -1), (0, 1)])):
        beside = np.hypot(*(points + step).T) < RADIUS
        assert points[neighbours[beside, k]] == pytest.approx(points[beside] + step)
        assert (neighbours[~beside, k] == np.flatnonzero(~beside)).all()


@pytest.fixture
def coarse(monkeypatch):
    """Charts have few columns, and areas few frequencies."""
    for name, value in (("COLUMNS", 3), ("MAX_COLUMNS", 3), ("COUNT", 5)):
        monkeypatch.setattr(f"active_surface.studies.feasibility.case.{name}", value)


@pytest.mark.slow
@pytest.mark.compiled
def test_command_writes_map_and_labelled_data(tmp_path, coarse):
    import xarray

    case = write_case(read_case(CASE).vary({"run.duration": "3.4 ms"}), tmp_path / "case" / "one_actuator.toml")
    tmp_path = tmp_path / "out"
    options = ["--lowest", "100 Hz", "--highest", "2 kHz", "--json", "--output", str(tmp_path)]
    options += ["--smallest", "50 um", "--largest", "300 um"]
    alone = CliRunner().invoke(main, ["feasibility", str(case), *options])
    with xarray.open_dataset(tmp_path / "one_actuator.feasibility.nc", engine="h5netcdf") as data:
        assert set(data.dims) == {"column"} and set(data) == {"slips_from", "lost_from", "all_lost_from", "valid_to"}
    done = CliRunner().invoke(main, ["feasibility", str(case), "--areas", "--across", "30", *options])
    assert alone.exit_code == done.exit_code == 0, done.output
    figures = json.loads(done.stdout)
    map_alone = json.loads(alone.stdout) | {"warnings": figures["warnings"]}  # areas have warnings of their own
    assert figures | map_alone == figures and "window" not in map_alone
    moves, loses = figures["moves_it_from_between"], figures["loses_it_from_between"]
    assert 100 <= moves[0] < moves[1] <= 300 <= loses[0] < loses[1] <= 2000  # its columns are 100, 300 and 2000 Hz
    assert figures["frequencies"] == pytest.approx([100, 2000])
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "one_actuator.feasibility.nc", "one_actuator.feasibility.png",
    ]  # fmt: skip
    with xarray.open_dataset(tmp_path / "one_actuator.feasibility.nc", engine="h5netcdf") as data:
        assert data["peak_area"].dims == ("frequency",) and data["peak_area"].attrs["units"] == "m^2"
        assert float(data["peak_area"].max()) == pytest.approx(figures["largest_peak_area"])
    own = case.read_text().replace("[run]", "# Its first cycle only.\n[run]")
    case.write_text(own)
    done = CliRunner().invoke(main, ["feasibility", str(case), "--pick", "best", *options])
    assert done.exit_code == 0, done.output
    said, written = (tmp_path / "one_actuator_picked.toml").read_text().split("\n\n", 1)
    assert said.startswith("# At ") and written.split("[part]")[1] == own.split("[part]")[1]


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--lowest", "5 um"], "--lowest must be a frequency"),
        (["--lowest", "5 kHz", "--highest", "1 kHz"], "below the highest"),
        (["--highest", "10 Hz"], "  --highest must be above the lowest, by default a quarter of the case's, 75 Hz"),
        (
            ["--lowest", "90 kHz"],
            "--lowest must be positive and below the highest, by default eight times the case's, 2.4 kHz",
        ),
        (["--areas", "--across", "3"], "--across must be in [10, 1000]; got 3"),
        (["--areas", "--across", "0"], "--across must be in [10, 1000]; got 0"),
        (["--across", "30"], "--across must not be given without --areas, whose places it counts"),
        (
            ["--pick", "600Hz"],
            '--pick must be "best", or a frequency and a stroke such as "2.4 kHz, 12 um"; got "600Hz"',
        ),
        (["--pick", "600um,80Hz"], '--pick must be a frequency such as "300 Hz"; got "600um", a length'),
        (["--smallest", "5 Hz"], '--smallest must be a length such as "12 um"; got "5 Hz", a frequency'),
        (["--smallest", "3 mm"], "--smallest must leave a range of strokes; got 3 mm to 2.4 mm"),
        (["--largest", "1 nm"], "--largest must leave a range of strokes; got 146 nm to 1 nm"),
    ],
)
def test_command_refuses_what_makes_no_sense(tmp_path, options, said):
    done = CliRunner().invoke(main, ["feasibility", CASE, *options, "-o", str(tmp_path / "new")])
    assert done.exit_code == 2 and said in done.output
    assert not (tmp_path / "new").exists()


@pytest.mark.compiled
def test_only_the_frequencies_asked_for_are_in_the_curves(coarse):
    found = feasibility(read_case(CASE).vary(SHORT), 1000.0, 2000.0, 12, areas=True)
    assert found.areas.factors * 300 == pytest.approx(np.geomspace(1000, 2000, 5))
    assert found.figures()["moves_it_from_between"] == [None, pytest.approx(1000)]
    assert found.areas.own.integral > 0


@pytest.mark.compiled
@pytest.mark.slow
def test_a_picked_case_moves_and_a_point_that_does_not_is_refused_with_its_borders(tmp_path, coarse):
    found = feasibility(read_case(CASE).vary(SHORT), 600.0, 1200.0, 10, smallest=1e-6, largest=2e-3)
    frequencies, slips, lost, _ = found.borders()
    picked = pick(found, float(frequencies[0]), float(np.sqrt(slips[0] * lost[0])))
    assert run_case(read_case(write_case(picked.case, tmp_path / "picked.toml"))).summary.path_length > 0
    for stroke, what in (
        (0.9 * slips[0], "where it stays at rest"),
        (1.0002 * slips[0], r"where it moves only [\d.]+ [np]m"),
        (2e-3, "where it is lost after"),
    ):
        with pytest.raises(ValueError, match=what) as refused:
            pick(found, float(frequencies[0]), float(stroke))
        assert f"it slips from {quantity_text(slips[0], 'm', 4)} and is lost from" in str(refused.value)


@pytest.mark.compiled
def test_where_nothing_moves_a_run_slips_with_the_share_of_friction_stated_and_not_above(coarse):
    """A law without pull-off that holds everything up to the largest stroke."""
    case = read_case(CASE).vary(SHORT | {"friction": {"model": "constant", "limit": "2 uN"}})
    found = feasibility(case, 200.0, 400.0, smallest=1e-6, largest=1e-4)
    near = found.nearest
    assert found.own == "rest" and found.areas is None and near is not None and near.share < 1
    row = dict(lines(found.figures()))["nearest"]
    assert f"the pull reaches {near.share:.3g} of the friction limit at 400 Hz" in row
    there = found.at(near.frequency * found.frequency, near.stroke * found.stroke)
    for share, moves in ((0.999, True), (1.001, False)):
        weaker = there.vary({"friction": {"model": "constant", "limit": f"{2 * share * near.share} uN"}})
        assert (follow_part(weaker, build_surface(weaker), build_friction(weaker)).path_length > 0) == moves


@pytest.mark.parametrize("other", [3, "a.toml"])
def test_what_is_no_case_is_refused(other):
    with pytest.raises(ValueError, match=f"^Input case of feasibility must be a Case, .* got {other!r}$"):
        feasibility(other)


def test_a_platform_is_refused():
    with pytest.raises(ValueError, match="platform"):
        feasibility(read_case("examples/shaker.toml"))
