"""Drift: basins of fields whose ends are known, and maps against single runs."""

import json
from pathlib import Path

import numpy as np
import pytest
import xarray
from click.testing import CliRunner

from active_surface.cli.program import main
from active_surface.studies.drifts import Fate, Field, basins_of, drift, running_groups, runs
from active_surface.studies.drifts.maps import Check, place_text
from active_surface.studies.drifts.runs import _ground
from common import percent
from coupling import SolvedPlates, build_friction, build_surface, read_case, silent
from coupling.borders import KEPT
from coupling.case import endless_case, groups_of, running_case
from particle import Micropart, simulate

SPACING, ACROSS = 2e-5, 12  # m, places to each side
ARRAY = "examples/array_3x3.toml"


def field_of(moved, fates=None):
    """The field and the places of displacements (n, 2) [spacing] as a function of (n, 2) [spacing]."""
    along = np.arange(-ACROSS, ACROSS + 1, dtype=float)
    grid = np.stack(np.meshgrid(along, along, indexing="ij"), axis=-1).reshape(-1, 2)
    found = np.full(len(grid), int(Fate.MOVES)) if fates is None else fates(grid)
    ways = moved(grid) * (found == Fate.MOVES)[:, None]
    found[(found == Fate.MOVES) & ~ways.any(axis=1)] = Fate.STAYS
    return Field.of(SPACING * grid, SPACING, SPACING * ways, found), SPACING * grid


def share(basins, x, y):
    """The share that ends at a place [spacing], to a tenth of the spacing."""
    near = [end for end in basins.ends if np.hypot(end.place[0] / SPACING - x, end.place[1] / SPACING - y) < 0.1]
    return sum(end.share for end in near)


@pytest.mark.parametrize("pace", [0.4, 1e-3, 1e-5])
def test_a_saddle_parts_two_sinks_whatever_the_pace(pace):
    """Along x away from 0 to sinks at -6 and 6, along y to 0; who starts at x = 0 stays on the line."""

    def moved(place):
        x, y = place.T
        return pace * np.stack([np.sign(x) * (6 - abs(x)) / 2, -y], axis=1)

    field, places = field_of(moved)
    basins = basins_of(field, places)
    count = 2 * ACROSS + 1
    sides = np.array([np.sign(end.place[0]) * (abs(end.place[0]) > SPACING) for end in basins.ends])
    moving = basins.of_start >= 0
    assert (sides[basins.of_start[moving]] == np.sign(places[moving, 0])).all()
    assert share(basins, 6, 0) == share(basins, -6, 0) == pytest.approx((ACROSS * count - 1) / count**2)
    assert share(basins, 0, 0) == pytest.approx((count - 1) / count**2)
    assert basins.stay == pytest.approx(3 / count**2)  # at the sinks and the saddle
    assert (basins.come_off, basins.leave) == (0.0, 0.0)


def test_parts_end_in_dead_zones_are_lost_at_spots_and_leave_over_the_rim():
    """All go right by 0.3 spacings: below into a dead zone from x = 8 on, then onto a spot, above over the rim."""

    def fates(place):
        x, y = place.T
        return np.select([(y < -3.5) & (x > 7.5), (abs(y) < 3.5) & (x == 3)], [Fate.STAYS, Fate.COMES_OFF], Fate.MOVES)

    field, places = field_of(lambda place: np.array([0.3, 0.0]) + 0 * place, fates)
    basins = basins_of(field, places)
    x, y = (places / SPACING).round().T
    dead, spot = y < -3.5, (abs(y) < 3.5) & (x <= 3)
    expected = np.where(dead & (x > 7.5), -1, np.where(dead, 0, np.where(spot, -2, -3)))
    assert (basins.of_start == expected).all()
    assert basins.stay == (expected == -1).mean() and basins.come_off == spot.mean()
    ends = basins.reached[expected == 0, 0] / SPACING
    assert (ends > 7.4).all() and (ends < 8.3).all()  # at its edge, beyond by no more than a period
    assert len(basins.ends) == 1 and basins.ends[0].extent == pytest.approx(8 * SPACING)  # all along it


def test_to_and_fro_ends_in_its_middle():
    """A period carries a part from where it is to the other side of the middle, by 2 % less far each time."""
    field, places = field_of(lambda place: -1.98 * place)
    basins = basins_of(field, places)
    assert share(basins, 0, 0) == pytest.approx(1 - 1 / len(places))


def test_many_periods_are_the_map_again_and_again():
    field, places = field_of(lambda place: -0.1 * place)
    within = places[::7] + 0.3 * SPACING * (abs(places[::7]) < 11 * SPACING)
    ends, fates = field.carried(within, 5)
    assert np.allclose(ends, 0.9**5 * within, atol=1e-12 * SPACING)
    assert (fates <= Fate.MOVES).all()


def test_places_have_digits_that_mean_something():
    assert place_text((-1.317e-4, -5.6e-17), 1.5e-5) == "(-131.7, 0.0) um"
    assert place_text((2.58e-3, -1e-9), 2.7e-4) == "(2580, 0) um"


def test_the_check_says_how_far_runs_go():
    assert Check(8, 20, 81e-6, 21e-6).text == (
        "8 runs of 20 periods from places in between: they go 81 um and end 21 um from where the map says, medians"
    )
    assert Check(3, 1, otherwise=2).text.endswith("2 lost where it keeps them, or kept where it loses them")
    assert Check(3, 1).text.endswith("they are lost, as the map says")
    assert Check(8, 20, 2e-6, 3e-6).is_far and not Check(8, 20, 2e-6, 0.5e-6).is_far and not Check().is_far


def test_groups_of_a_lattice():
    case = read_case("examples/device.toml")
    columns, rows = groups_of(case, "columns"), groups_of(case, "rows")
    assert list(columns) == ["column 0", "column 1", "column 2"] and list(rows) == ["row 0", "row 1", "row 2"]
    for along, groups in ((0, columns), (1, rows)):
        places = [{round(case.actuators[k].position[along], 9) for k in group} for group in groups.values()]
        assert [sorted(one) for one in places] == [[-6e-4], [0.0], [6e-4]]
    assert sorted(k for group in columns.values() for k in group) == list(range(9))
    assert groups_of(case, "all") == {"all": tuple(range(9))}
    assert groups_of(case, "each")["actuator 8"] == (8,)
    alone = running_case(case, columns["column 1"])
    assert [k for k, one in enumerate(alone.actuators) if one.stroke] == list(columns["column 1"])
    assert list(running_groups(alone, "columns")) == ["column 1"]  # groups at rest are left out


def last(old, new):
    """The text of the array's case with the last of some words replaced."""
    return new.join(Path(ARRAY).read_text().rsplit(old, 1))


SIDE = '["380 um", "380 um"]'  # of a part that has room only in the middle
LARGE = (
    'mass = "2e-9 kg"\nposition = ["50 um", "30 um"]',
    f'footprint = "rectangle"\nsides = {SIDE}\nthickness = "10 um"\nmass = "2e-9 kg"\nposition = ["0 um", "0 um"]',
)
REFUSED = {
    "period": (last('"500 Hz"', '"707.1067811865 Hz"'), [], "CASE must have drives with a common period"),
    "up": (last('delay = "1.6 ms"', 'cycle = "up"'), [], 'actuators[8].cycle must not be "up" here'),
    "still": (Path(ARRAY).read_text().replace('"50 um"\nfreq', '"0 um"\nfreq'), [], "CASE must have drives that move"),
    "film": (
        last('pressure = "0 Pa"', "film = true").replace('mass = "2e-9 kg"', 'size = "50 um"\nmass = "2e-9 kg"'),
        [],
        "CASE must not have a film of air",
    ),
    "groups": (
        Path(ARRAY).read_text(),
        ["--groups", "diagonals"],
        '--groups must be "all", "columns",',
    ),
    "room": (Path(ARRAY).read_text().replace(*LARGE), ["--across", "2"], "--across must let the part lie"),
}


def refusal(file, *options):
    """What the command says that refuses a case."""
    result = CliRunner().invoke(main, ["drift", str(file), "--quiet", *options])
    assert result.exit_code == 2, result.output
    return result.stderr


@pytest.mark.parametrize(("text", "options", "said"), REFUSED.values(), ids=REFUSED)
def test_the_command_refuses_what_has_no_drift(tmp_path, text, options, said):
    file = tmp_path / "case.toml"
    file.write_text(text)
    assert said in refusal(file, "-o", str(tmp_path / "out"), *options)
    assert not (tmp_path / "out").exists()


def test_the_command_refuses_a_platform():
    assert "CASE must have a plate" in refusal("examples/shaker.toml")


@pytest.fixture(scope="module")
def found():
    """The map of the array of three by three, whose rows are the mirror images of each other."""
    return drift(read_case(ARRAY), across=12)


@pytest.mark.compiled
def test_mirrored_arrays_have_mirrored_maps(found):
    one = found.maps[0]
    places = {(round(x, 9), round(y, 9)): k for k, (x, y) in enumerate(one.starts.tolist())}
    mirror = [places[round(x, 9), round(-y, 9)] for x, y in one.starts.tolist()]
    assert (one.fates == one.fates[mirror]).all() and (one.fates == Fate.MOVES).sum() > 30
    size = np.abs(one.moved).max()
    assert one.moved[mirror] == pytest.approx(one.moved * [1, -1], abs=1e-3 * size)
    assert np.abs(one.moved[:, 0] + one.moved[::-1, 0]).max() > 0.01 * size  # columns start at other times


@pytest.mark.compiled
def test_actuators_at_rest_are_none_that_run():
    one = drift(running_case(read_case(ARRAY), (0, 3, 6)), across=4).maps[0]
    assert (one.name, one.actuators) == ("all", (0, 3, 6))


@pytest.mark.compiled
def test_files_hold_the_map(found, tmp_path):
    data, picture = found.write(tmp_path)
    one = found.maps[0]
    with xarray.open_dataset(data, engine="h5netcdf") as read:
        assert read["dx"].dims == ("group", "place") and read["group"].values.tolist() == ["all"]
        assert (read["dy"].values[0] == one.moved[:, 1]).all() and (read["x"].values == one.starts[:, 0]).all()
        assert (read["end"].values[0] == one.basins.of_start).all()
    assert picture.stat().st_size > 20_000
    json.dumps(found.figures(), allow_nan=False)
    rows = found.lines()
    assert rows[1][0] == "all" and " end at (" in rows[1][1] and "e-" not in rows[1][1]


@pytest.fixture(scope="module")
def single():
    """A map, and runs over its periods from 200 of its places, with a tight tolerance."""
    case = endless_case(read_case(ARRAY))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(runs, "SLIDING", 1.0)  # so that the map is of the first period
        one = drift(case, across=30).maps[0]
    steady = case.model_copy(update={"run": case.run.model_copy(update={"start": "steady", "duration": one.period})})
    surface, law = build_surface(steady), build_friction(case)
    chosen = np.random.default_rng(7).choice(len(one.starts), 200, replace=False)

    def run(place, periods=1):
        return simulate(surface, Micropart(case.part.mass, place), law, periods * one.period, tolerance=1e-11)

    return one, chosen, run


@pytest.mark.slow
@pytest.mark.compiled
def test_a_map_is_what_single_runs_do(single):
    """Measured: they differ by up to 1.5e-4 of the spacing, 3 nm, of ways of up to 37 um."""
    one, chosen, run = single
    ways = np.array([np.subtract(*run(tuple(place)).position[[-1, 0]]) for place in one.starts[chosen]])
    moves = one.fates[chosen] == Fate.MOVES
    assert moves.sum() > 50 and (~moves).sum() > 50
    assert ways == pytest.approx(one.moved[chosen], abs=5e-4 * one.field.spacing)


@pytest.mark.slow
@pytest.mark.compiled
def test_what_never_slips_does_not_move_in_a_run(single):
    one, chosen, run = single
    case = endless_case(read_case(ARRAY))
    still = _ground(case, one.period, None, SolvedPlates(), silent).never_slips(one.starts)[chosen]
    assert still.sum() > 50
    assert all((run(tuple(place)).position == place).all() for place in one.starts[chosen[still]])


@pytest.mark.slow
@pytest.mark.compiled
def test_ends_of_runs_from_in_between_are_near_those_of_the_map(single):
    """Half of the parts still move when the first period ends; a later one says better where they go.

    Measured: of 40, the median gap is 0.08 of the median way; by the map of the first period 0.22.
    """
    first, _, run = single
    one = drift(read_case(ARRAY), across=30).maps[0]
    assert one.after > 0 and one.sliding > 0.4
    assert one.later == f" ({percent(one.sliding)} still move when the first ends; this is no. {one.after + 1})"
    chance = np.random.default_rng(3)
    movers = one.starts[one.fates == Fate.MOVES]
    places = movers[chance.choice(len(movers), 40, replace=False)] + one.field.spacing * chance.uniform(
        -0.5, 0.5, (40, 2)
    )
    ends, fates = one.field.carried(places, 20)
    at_first, _ = first.field.carried(places, 20)
    paths = [run(tuple(place), 20) for place in places]
    assert (fates <= Fate.MOVES).all() and all(path.outcome in KEPT for path in paths)
    theirs = np.array([path.position[-1] for path in paths])
    gap, of_first, way = (np.median(np.hypot(*(theirs - other).T)) for other in (ends, at_first, places))
    assert way > 2 * one.field.spacing and gap < 0.15 * way and gap < 0.6 * of_first, (gap / way, of_first / way)
