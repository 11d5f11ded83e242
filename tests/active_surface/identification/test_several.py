"""Several tracks with shared and own fields: against weighted regression, and what is wrong with their input."""

from __future__ import annotations

import json

import numpy as np
import pytest
from click.testing import CliRunner
from scipy.stats import t as student

from active_surface import Case, Track, identify, read_case
from active_surface.cli.program import main
from active_surface.identification.parameters import parameters_of
from active_surface.identification.search import search
from active_surface.identification.trials import Loss, Recording, Trials
from coupling import build_surface
from coupling.case import write_case

MASS, COEFFICIENT, GRAVITY, SPEED = 2e-9, 0.5, 9.80665, 1.0
SQUEEZES, NOISES, COUNTS = (1e-8, 2e-8, 3e-8), (1e-4, 5e-4, 5e-5), (40, 25, 12)
BOUNDS = {"part.velocity.0": (0.5, 2.0)}
FREE, OWN = ["part.velocity.0"], ["part.squeeze"]


def braking(name: str = "braking", **part: object) -> Case:
    """A part that friction brakes on a platform at rest: x = v t - a t^2 / 2, a = coefficient (g + squeeze / mass)."""
    return Case(
        plate={"shape": "platform"},
        actuators=(),
        part={"mass": MASS, "position": (0.0, 0.0), "velocity": (SPEED, 0.0), "squeeze": 2e-8} | part,
        friction={"model": "coulomb", "coefficient": COEFFICIENT},
        run={"duration": 0.1},
        name=name,
    )


def braked(squeeze: float, noise: float, count: int, seed: int) -> Track:
    """The closed form with noise along x; y was not measured."""
    times = np.linspace(0.002, 0.07, count)
    x = SPEED * times - COEFFICIENT * (GRAVITY + squeeze / MASS) * times**2 / 2
    x += noise * np.random.default_rng(seed).standard_normal(count)
    return Track(times, np.column_stack([x, np.full_like(x, np.nan)]))


@pytest.fixture(scope="module")
def tracks() -> list[Track]:
    return [braked(*one, seed) for seed, one in enumerate(zip(SQUEEZES, NOISES, COUNTS, strict=True))]


@pytest.fixture(scope="module")
def found(tracks):
    cases = [braking(f"run {k}") for k in range(3)]
    return identify(cases, tracks, FREE, BOUNDS, own=OWN, threads=1)


def regression(tracks: list[Track]) -> tuple[np.ndarray, np.ndarray]:
    """Speed and decelerations by dense least squares with variances that follow from residuals, and their reach."""
    sizes = np.array([len(track.time) for track in tracks])
    freedom = sizes - 1 - sizes / sizes.sum()
    designs = []
    for k, track in enumerate(tracks):
        designs.append(np.zeros((len(track.time), 1 + len(tracks))))
        designs[-1][:, 0], designs[-1][:, 1 + k] = track.time, -(track.time**2) / 2
    variance = np.ones(len(tracks))
    for _ in range(100):
        parts = [design.T @ design / one for design, one in zip(designs, variance, strict=True)]
        inverse = np.linalg.inv(sum(parts))
        pull = sum(d.T @ track.position[:, 0] / one for d, track, one in zip(designs, tracks, variance, strict=True))
        value = inverse @ pull
        left = [track.position[:, 0] - d @ value for d, track in zip(designs, tracks, strict=True)]
        variance = np.array([one @ one for one in left]) / freedom
    shares = np.array([np.diag(inverse @ part @ inverse) for part in parts])
    known = shares.sum(axis=0) ** 2 / (shares**2 / freedom[:, None]).sum(axis=0)
    return value, student.ppf(0.975, known) * np.sqrt(np.diag(inverse))


def trials_of(tracks: list[Track], loss: Loss = "squares") -> Trials:
    cases, surface = [braking()] * len(tracks), build_surface(braking())
    rows = parameters_of(cases, tracks, FREE, OWN, BOUNDS)
    recordings = [Recording(*one) for one in zip(cases, [surface] * len(tracks), tracks, rows, strict=True)]
    return Trials(recordings, len(FREE), loss, 1)


@pytest.mark.parametrize("loss", ["squares", "absolute"])
def test_the_weights_of_least_squares_are_the_slopes_of_the_cost(tracks, loss):
    trials, change = trials_of(tracks, loss), 1e-6
    residuals = np.random.default_rng(0).uniform(1e-4, 3e-4, trials.size) * np.repeat([1, 5, 0.3], COUNTS)
    cost, slopes, curvature = trials.robust(residuals**2)
    assert cost.sum() == pytest.approx(trials.cost(residuals)) and not curvature.any()
    for k in (0, 50, 70):
        sides = [np.array(residuals) for _ in range(2)]
        sides[0][k], sides[1][k] = residuals[k] * (1 - change), residuals[k] * (1 + change)
        low, high = (trials.cost(one) for one in sides)
        assert slopes[k] == pytest.approx((high - low) / (sides[1][k] ** 2 - sides[0][k] ** 2), rel=1e-5)


def test_one_trial_a_field_gives_the_slopes_of_all_tracks(tracks):
    """Places are linear in the speed and, by each track's own squeeze, in its deceleration."""
    trials = trials_of(tracks)
    (trial,) = trials.of(np.full((1, trials.count), 0.5))
    followed, slope = trials.followed, trials.slopes(trial, 1e-4, np.ones(trials.count, dtype=bool))
    assert trials.followed == followed + 2 * len(tracks)
    for k, (track, rows) in enumerate(zip(tracks, trials.rows, strict=True)):
        squeeze = 2e-8 * np.log(100)  # over the share of its bounds, in the middle
        np.testing.assert_allclose(slope[rows, 0], np.log(4) * SPEED * track.time, rtol=1e-3)
        np.testing.assert_allclose(slope[rows, 1 + k], -COEFFICIENT * squeeze / MASS * track.time**2 / 2, rtol=1e-3)
        assert np.count_nonzero(slope[rows].any(axis=0)) == 2
    fixed = trials.slopes(trial, 1e-4, np.array([False, True, False, True]))
    assert not fixed[:, [0, 2]].any() and fixed[:, [1, 3]].any(axis=0).all()


def test_values_and_intervals_are_those_of_weighted_regression(tracks, found):
    """Places are linear in speed and decelerations; noises differ tenfold, and follow from the residuals."""
    value, reach = regression(tracks)
    for estimate, middle, half in zip(found.estimates, value, reach, strict=True):
        ends = np.array([middle, middle - half, middle + half])
        if estimate.case is not None:
            ends = MASS * (ends / COEFFICIENT - GRAVITY)
        width = ends[2] - ends[1]
        assert estimate.value == pytest.approx(ends[0], abs=0.02 * width)
        assert (estimate.low, estimate.high) == pytest.approx((ends[1], ends[2]), abs=0.05 * width)


def test_the_result_names_the_track_of_an_own_field(found):
    assert [one.label for one in found.estimates] == [*FREE, *(f"part.squeeze of run {k}" for k in range(3))]
    assert found.table.loc[("part.squeeze", "run 1"), "value"] == found.fits[1].case.part.squeeze
    assert {fit.case.part.velocity[0] for fit in found.fits} == {found.table.loc[("part.velocity.0", ""), "value"]}
    assert [fit.case.name for fit in found.fits] == [f"run {k}_identified" for k in range(3)]
    assert [fit.residual for fit in found.fits] == pytest.approx(NOISES, rel=0.5)
    assert all(first not in OWN[0] or "velocity" in second for first, second, _ in found.alike)
    with pytest.raises(ValueError, match="take one of fits"):
        _ = found.case


def test_a_track_alone_gives_longer_intervals_than_beside_others(tracks, found):
    alone = identify(braking(), tracks[1], [*FREE, *OWN], BOUNDS, threads=1)
    beside = found.estimates[2]
    assert alone.estimates[1].high - alone.estimates[1].low > 2 * (beside.high - beside.low)


@pytest.mark.slow
def test_the_search_costs_as_much_for_each_track_however_many_there_are(tracks):
    def followed(count: int) -> int:
        trials = trials_of((tracks * 2)[:count])
        search(trials, 0)
        return trials.followed

    assert followed(6) < 2 * 3 * followed(2)


@pytest.mark.slow
def test_tracks_of_one_case_may_share_all_fields(tmp_path):
    """Two recordings of one run: the value is the mean of both by their widths, the interval as long as of that."""
    pair = [braked(2e-8, noise, 40, seed) for seed, noise in ((5, 1e-4), (6, 2e-4))]
    both = identify(braking(squeeze=1e-8), pair, OWN, threads=1)
    each = [identify(braking(squeeze=1e-8), track, OWN, threads=1).estimates[0] for track in pair]
    (one,) = both.estimates
    weights = np.array([(alone.high - alone.low) ** -2 for alone in each])
    width = weights.sum() ** -0.5
    assert one.value == pytest.approx(weights @ [alone.value for alone in each] / weights.sum(), abs=0.05 * width)
    assert one.high - one.low == pytest.approx(width, rel=0.08)
    assert [fit.name for fit in both.fits] == ["braking_0", "braking_1"]
    assert [file.name for file in both.written(tmp_path).files] == ["braking_identified.toml", "braking_identified.png"]


@pytest.mark.slow
def test_tracks_without_a_shared_field_are_as_if_alone(tracks):
    cases = [braking("a"), braking("b")]
    together = identify(cases, tracks[:2], own=OWN, threads=1)
    for estimate, case, track in zip(together.estimates, cases, tracks, strict=False):
        (alone,) = identify(case, track, OWN, threads=1).estimates
        width = alone.high - alone.low
        for end in ("value", "low", "high"):
            assert getattr(estimate, end) == pytest.approx(getattr(alone, end), abs=0.04 * width)


@pytest.mark.slow
def test_distances_of_several_tracks_withstand_outliers(tracks):
    spoilt = [Track(track.time, np.array(track.position)) for track in tracks[:2]]
    for track, noise in zip(spoilt, NOISES, strict=False):
        track.position[::9, 0] += 50 * noise
    result = identify([braking("a"), braking("b")], spoilt, FREE, BOUNDS, own=OWN, loss="absolute", threads=1)
    for estimate, true in zip(result.estimates, (SPEED, *SQUEEZES), strict=False):
        assert estimate.low < true < estimate.high
        assert estimate.high - estimate.low < 0.2 * true


FEW = Track(np.array([0.01, 0.02]), np.array([[0.0, np.nan], [0.0, np.nan]]))


@pytest.mark.parametrize(
    ("count", "own", "said"),
    [
        (4, OWN, "track of identify must be one for each case, or all of one case; got 4 tracks for 2 cases"),
        (2, FREE, "free and own of identify must name each field once; got part.velocity.0 twice"),
        (2, OWN, r"bounds of identify for part.squeeze must be given.*\(case b\)"),
        (1, OWN * 2, r"track\[1\] of identify must have more places than free fields, 3, .* got 2 until 0.02 s"),
    ],
)
def test_wrong_input_of_several_is_named(tracks, count, own, said):
    cases = [braking("a"), braking("b", squeeze=0.0)]
    with pytest.raises(ValueError, match=said):
        identify(cases, [*tracks, FEW][:count] if count > 1 else [tracks[0], FEW], FREE, BOUNDS, own=own)


@pytest.fixture
def folder(tmp_path, monkeypatch, tracks):
    monkeypatch.chdir(tmp_path)
    for name, track in zip("ab", tracks, strict=False):
        write_case(braking(), tmp_path / f"{name}.toml")
        rows = "".join(f"{1e3 * t}, {1e6 * x}\n" for t, (x, _) in zip(track.time, track.position, strict=True))
        (tmp_path / f"{name}.csv").write_text("time [ms], x [um]\n" + rows)
    return tmp_path


@pytest.mark.slow
def test_the_command_takes_a_track_for_each_case(folder):
    words = ["identify", "a.toml", "b.toml", "--track", "a.csv", "b.csv", "--free", *FREE, "--own", *OWN]
    done = CliRunner().invoke(main, [*words, "--bounds", "part.velocity.0=500 mm/s,2 m/s", "-t", "1", "--json"])
    assert done.exit_code == 0, done.output
    figures = json.loads(done.stdout)
    for name, squeeze in zip("ab", SQUEEZES, strict=False):
        field = figures["fields"][f"part.squeeze of {name}"]
        assert field["low"] < squeeze < field["high"]
        written = folder / f"results/{name}_identified.toml"
        assert read_case(written).part.squeeze == field["value"]
        assert "# part.squeeze = " in written.read_text()
    assert (folder / "results/a_identified.png").stat().st_size > 10_000
    assert len(figures["files"]) == 3


def test_the_command_refuses_files_and_fields_by_name(folder):
    words = ["identify", "--track", "a.csv", "b.csv", "a.csv", "a.toml", "b.toml", "--free", *OWN, "--own", *OWN, *FREE]
    done = CliRunner().invoke(main, words)
    assert done.exit_code == 2
    assert "got 3 tracks for 2 cases" in done.stderr
    (folder / "results").mkdir()  # an earlier result comes after what is wrong with the input
    (folder / "results/a_identified.toml").write_text("")
    done = CliRunner().invoke(main, ["identify", "--track", "a.csv", "b.csv", "a.toml", "--free", "part.masb"])
    assert done.exit_code == 2 and "  --free must be a field of the case; part has no masb" in done.stderr
    bounds = ["--free", "part.mass", "--bounds", "part.mass=1,2"]
    done = CliRunner().invoke(main, ["identify", "--track", "a.csv", "b.csv", "a.toml", *bounds])
    assert done.exit_code == 2 and "  --bounds for part.mass must be a mass such as" in done.stderr
    done = CliRunner().invoke(main, ["identify", "--track", "a.csv", "b.csv", "a.toml", *bounds[:2]])
    assert done.exit_code == 2 and "  --output must be free of other results; got results" in done.stderr
    (folder / "b.csv").write_text("time [ms], x [um]\n1000, 0\n")
    done = CliRunner().invoke(main, ["identify", "--track", "a.csv", "b.csv", "a.toml", *bounds[:2]])
    assert done.exit_code == 2 and "  --track in b.csv must end within the run's duration" in done.stderr
    (folder / "b.csv").write_text("time [ms], x [um]\n")
    done = CliRunner().invoke(main, words)
    assert done.exit_code == 2 and "b.csv: must have rows below its header" in done.stderr
    (folder / "b.toml").write_text((folder / "b.toml").read_text().replace("mass", "masb"))
    done = CliRunner().invoke(main, words)
    assert done.exit_code == 2 and "masb" in done.stderr
