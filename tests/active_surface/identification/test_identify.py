"""Identification: fields and intervals against linear regression, and what a track does not determine."""

from __future__ import annotations

import json
from itertools import pairwise
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from scipy.stats import t as student

from active_surface import Case, Track, identify, read_case, read_track
from active_surface.cli.program import main
from active_surface.identification.estimate import TrackFit
from active_surface.identification.pictures import _draw_map
from coupling.case import write_case

MASS, COEFFICIENT, SQUEEZE, GRAVITY, SPEED = 2e-9, 0.5, 2e-8, 9.80665, 1.0
TIMES = np.linspace(0.002, 0.08, 40)  # s; the part stops at 0.1 s
NOISE = 1e-4  # m


def braking(**part: object) -> Case:
    """A part that friction brakes on a platform at rest: x = v t - a t^2 / 2, a = coefficient (g + squeeze / mass)."""
    return Case(
        plate={"shape": "platform"},
        actuators=(),
        part={"mass": MASS, "position": (0.0, 0.0), "velocity": (SPEED, 0.0), "squeeze": SQUEEZE} | part,
        friction={"model": "coulomb", "coefficient": COEFFICIENT},
        run={"duration": 0.2},
        name="braking",
    )


def braked(seed: int = 3, outliers: int = 0) -> Track:
    """The closed form with noise along x; y was not measured."""
    rate = COEFFICIENT * (GRAVITY + SQUEEZE / MASS)
    generator = np.random.default_rng(seed)
    x = SPEED * TIMES - rate * TIMES**2 / 2 + NOISE * generator.standard_normal(len(TIMES))
    x[generator.permutation(len(x))[:outliers]] += 50 * NOISE
    return Track(TIMES, np.column_stack([x, np.full_like(x, np.nan)]))


def squeeze_of(rate: float) -> float:
    return MASS * (rate / COEFFICIENT - GRAVITY)


def test_value_and_interval_are_those_of_linear_regression():
    """The place is linear in the deceleration, so the interval is that of Student's t."""
    track = braked()
    found = identify(braking(squeeze=SQUEEZE / 4), track, ["part.squeeze"], threads=1)
    slope, rest = -(TIMES**2) / 2, track.position[:, 0] - SPEED * TIMES
    rate = slope @ rest / (slope @ slope)
    error = np.sqrt(np.sum((rest - slope * rate) ** 2) / (len(TIMES) - 1) / (slope @ slope))
    reach = student.ppf(0.975, len(TIMES) - 1) * error
    (one,) = found.estimates
    width = squeeze_of(rate + reach) - squeeze_of(rate - reach)
    assert one.value == pytest.approx(squeeze_of(rate), abs=0.01 * width)
    assert one.low == pytest.approx(squeeze_of(rate - reach), abs=0.03 * width)
    assert one.high == pytest.approx(squeeze_of(rate + reach), abs=0.03 * width)
    assert one.determined and not found.warnings()
    assert found.case.part.squeeze == one.value and found.case.name == "braking_identified"
    assert found.table.loc["part.squeeze", "value"] == one.value
    assert found.residual == pytest.approx(NOISE, rel=0.3)


def test_the_result_is_the_same_for_any_number_of_threads():
    one, three = (identify(braking(), braked(), ["part.squeeze", "part.mass"], threads=count) for count in (1, 3))
    assert one.estimates == three.estimates and one.paths == three.paths
    assert (one.correlation == three.correlation).all()


def test_least_distance_is_the_weighted_median_which_outliers_hardly_move():
    track = braked(outliers=5)
    found = identify(braking(), track, "part.squeeze", loss="absolute", threads=1)
    rates = (SPEED * TIMES - track.position[:, 0]) / (TIMES**2 / 2)
    order = np.argsort(rates)
    weight = np.cumsum(TIMES[order] ** 2)
    median = rates[order][np.searchsorted(weight, weight[-1] / 2)]
    (one,) = found.estimates
    assert one.value == pytest.approx(squeeze_of(median), rel=1e-3)
    assert one.low < SQUEEZE < one.high
    (by_squares,) = identify(braking(), track, ["part.squeeze"], threads=1).estimates
    assert by_squares.high - by_squares.low > 2 * (one.high - one.low)


def test_fields_that_do_the_same_are_named_and_have_long_intervals():
    """Only squeeze over mass counts here."""
    found = identify(braking(), braked(), ["part.squeeze", "part.mass"], threads=1)
    assert [pair[:2] for pair in found.alike] == [("part.squeeze", "part.mass")]
    assert found.alike[0][2] > 0.99
    assert "can hardly be distinguished" in found.warnings()[0]
    ratio = [one.high / one.low for one in found.estimates]
    assert min(ratio) > 50
    assert found.case.part.squeeze / found.case.part.mass == pytest.approx(SQUEEZE / MASS, rel=0.05)


def test_a_field_without_any_effect_is_not_determined():
    found = identify(braking(), braked(), ["part.squeeze", "part.size"], {"part.size": ("1 um", "1 mm")}, threads=1)
    squeeze, size = found.estimates
    assert squeeze.determined and not size.determined
    assert (size.low, size.high) == pytest.approx((1e-6, 1e-3))
    assert "part.size is not determined by this track" in found.warnings()


@pytest.mark.parametrize(("noise", "loss"), [(1e-6, "squares"), (0.0, "absolute")])
def test_a_part_that_stays_bounds_friction_on_one_side(noise, loss):
    """On a slope of 0.3 it stays with any coefficient above that."""
    case = braking(velocity=(0.0, 0.0), squeeze=0.0).vary({"run.gravity": (0.3 * GRAVITY, 0.0, -GRAVITY)})
    resting = Track(TIMES, noise * np.random.default_rng(0).standard_normal((len(TIMES), 2)))
    (one,) = identify(case, resting, ["friction.coefficient"], loss=loss, threads=1).estimates
    assert one.open_high and not one.open_low and one.determined
    assert one.low == pytest.approx(0.3, rel=2e-3 if noise else 0.02)
    assert "at least 0.3" in one.text


@pytest.mark.slow
def test_values_that_contradict_each_other_or_lie_off_the_plate_are_passed_over():
    """Static friction below sliding friction is no case, nor is a part beyond the rim."""
    case = braking().vary({"friction.static_coefficient": 0.6})
    found = identify(case, braked(), ["friction.coefficient", "friction.static_coefficient"], threads=1)
    low, high = (one.value for one in found.estimates)
    assert low == pytest.approx(COEFFICIENT, rel=0.02) and high >= low
    plate = {"shape": "disc", "radius": 3e-4, "supports": "clamped", "thickness": 5e-6}
    disc = Case(
        plate=plate | {"youngs_modulus": 169e9, "poisson_ratio": 0.3},
        actuators=[{"position": (0.0, 0.0), "stroke": 1e-6, "frequency": 300.0}],
        part={"mass": 2e-9, "position": (1e-4, 0.0)},
        friction={"model": "coulomb", "coefficient": 0.5},
        run={"duration": 2e-3},
    )
    still = Track(np.array([0.001, 0.0015, 0.002]), np.array([[2e-4, 1e-9], [2e-4, -1e-9], [2.00002e-4, 0.0]]))
    (place,) = identify(disc, still, ["part.position.0"], {"part.position.0": (-1e-3, 1e-3)}, threads=1).estimates
    assert place.value == pytest.approx(np.mean(still.position[:, 0]), abs=1e-9)


def test_residuals_that_are_not_noise_are_warned_of():
    track = braked()
    swinging = Track(TIMES, track.position + 1e-3 * np.sin(100 * TIMES)[:, None])
    found = identify(braking(), swinging, ["part.squeeze"], threads=1)
    assert any("residuals follow each other" in warning for warning in found.warnings())


LATE = Track(np.array([0.1, 0.3]), np.zeros((2, 2)))


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ({"free": ["part.sqeeze"]}, "free of identify .* did you mean squeeze"),
        ({"free": ["run.duration"]}, "free of identify must be fields of .part., .friction. or .air."),
        ({"free": ["part.position.0"]}, "Input bounds of identify for part.position.0 must be given"),
        (
            {"bounds": {"friction.coefficient": (3, 2)}},
            "bounds of identify for friction.coefficient must increase; got 3 and 2",
        ),
        ({"bounds": {"friction.coefficient": ("a", "b")}}, "must be two plain numbers; got .a."),
        ({"bounds": {"friction.coefficient": 0.2}}, "must be two values, such as 0.1, 0.9; got 0.2"),
        ({"bounds": {"part.mass": (1, 2)}}, "bounds of identify must be of free fields; got part.mass"),
        ({"free": []}, "free of identify must name at least one field"),
        ({"track": LATE}, "track of identify must end within the run's duration, 0.2 s; got 0.3 s"),
        ({"loss": "cubes"}, '"squares" or "absolute"; got .cubes.'),
    ],
)
def test_wrong_input_is_named(words, said):
    with pytest.raises(ValueError, match=said):
        identify(**{"case": braking(), "track": braked(), "free": ["friction.coefficient"]} | words)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("time [ms], x [um]\n1, 2\n1, 3\n", "line 3 must have a later time than the row before"),
        ("time [ms]\n1\n", "must have a column x or y"),
        ("time [um], x [um]\n1, 2\n", "must give time in a unit of"),
        ("time [ms], x [um]\n", "must have rows below its header"),
        ("time [ms], x [um]\n-1, 2\n", "must have a time of 0 or later"),
        ("time [ms], x [um]\n1, a\n", "line 2 must have a finite number as x"),
    ],
)
def test_a_file_that_is_no_track_is_refused_with_its_lines(tmp_path, text, said):
    file = tmp_path / "track.csv"
    file.write_text(text)
    with pytest.raises(ValueError) as refused:
        read_track(file)
    assert said in str(refused.value) and "track.csv" in str(refused.value)


def test_the_command_writes_the_case_and_a_picture(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write_case(braking(squeeze=SQUEEZE / 2), tmp_path / "braking.toml")
    rows = "".join(f"{1e3 * t}, {1e6 * x}\n" for t, (x, _) in zip(TIMES, braked().position, strict=True))
    (tmp_path / "track.csv").write_text("time [ms], x [um]\n" + rows)
    words = ["identify", "braking.toml", "--track", "track.csv", "-t", "1", "--free", "part.squeeze"]
    done = CliRunner().invoke(main, [*words, "--bounds", "part.squeeze=1 nN,100 nN", "--json"])
    assert done.exit_code == 0, done.output
    figures = json.loads(done.stdout)
    found = read_case(tmp_path / "results/braking_identified.toml")
    assert found.part.squeeze == figures["fields"]["part.squeeze"]["value"] == pytest.approx(SQUEEZE, rel=0.05)
    assert (tmp_path / "results/braking_identified.png").stat().st_size > 10_000
    before = (tmp_path / "results/braking_identified.toml").read_bytes()
    for more, said in (
        ([], "--overwrite replaces them"),
        (["friction.coeficient", "--overwrite"], "did you mean coefficient?"),
        (["--bounds", "part.squeeze", "--overwrite"], '--bounds must be like "part.squeeze=1 nN,10 nN"'),
    ):
        again = CliRunner().invoke(main, [*words, *more])
        assert again.exit_code == 2 and said in again.stderr
    assert (tmp_path / "results/braking_identified.toml").read_bytes() == before


def test_places_far_from_the_origin_are_legible_on_the_map() -> None:
    """In numbers of seven digits, as the way is a small part of the place."""
    way = np.column_stack([np.linspace(-250e-6, -248.8e-6, len(TIMES)), np.full(len(TIMES), 60e-6)])
    path: Any = SimpleNamespace(at=lambda times: SimpleNamespace(position=way))
    figure = Figure(figsize=(3.0, 4.0))
    axes = figure.add_subplot()
    _draw_map(axes, TrackFit("braking", braking(), Track(TIMES, way), path), legend=False)
    FigureCanvasAgg(figure).draw()
    labels = [one.get_window_extent() for one in axes.get_xticklabels() if one.get_text()]
    assert len(labels) >= 2 and all(one.x1 < other.x0 for one, other in pairwise(labels))
