"""Aim files and targets: what they say, and every mistake in one at once."""

import math

import pytest
from sweeps import PLATE, PLATFORM

from active_surface.steering import Route, Settings, Task, read_route, read_task
from active_surface.steering.read import read_place
from coupling import CaseError, read_case

ONE = PLATE[: PLATE.index("[[actuators]]")] + PLATE[PLATE.rindex("[[actuators]]") :]


def aim_file(folder, lines, case=PLATE):
    (folder / "base.toml").write_text(case)
    path = folder / "aim.toml"
    path.write_text(f'[aim]\ncase = "base.toml"\n{lines}')
    return path


def case_of(folder, text):
    (folder / "base.toml").write_text(text)
    return read_case(folder / "base.toml")


def mistakes(path, target=None):
    with pytest.raises(CaseError) as error:
        read_task(path, target)
    return [f"{problem.line} {problem.field} {problem.message}" for problem in error.value.problems]


def test_what_the_file_says_is_in_si_units(tmp_path):
    lines = 'target = ["10 um", "-0.02 mm"]\nfrequency = ["100 Hz", "0.6 kHz"]\n'
    lines += "cycles = [2, 7]\nactuators = [1]\nseed = 3\n"
    task = read_task(aim_file(tmp_path, lines))
    assert (task.target, task.movers, task.name, task.case.name) == ((1e-5, -2e-5), (1,), "aim", "base")
    assert (task.settings.frequency, task.settings.cycles, task.settings.seed) == ((100.0, 600.0), (2, 7), 3)
    assert (task.settings.tolerance, task.settings.max_paths) == (5e-7, 10_000)
    other = read_task(tmp_path / "aim.toml", (0.0, 5e-5), 0.9)
    assert (other.target, other.settings.quantile, other.settings.max_paths) == ((0.0, 5e-5), 0.9, 40_000)


def test_a_case_file_is_aimed_as_it_is(tmp_path):
    (tmp_path / "base.toml").write_text(PLATE)
    task = read_task(tmp_path / "base.toml", (1e-5, 0.0))
    assert (task.settings, task.movers, task.name) == (Settings(), (0, 1), "base")
    with pytest.raises(ValueError, match=r"^the target is missing"):
        read_task(tmp_path / "base.toml")


def test_all_mistakes_are_told_at_once(tmp_path):
    lines = """\
target = ["40 um", "0 um"]
frequency = ["600 Hz", "100 Hz"]
stroke = ["5 Hz", "10 um"]
actuators = [0, 0]
cycels = [1, 2]
tolerance = 5
"""
    told = mistakes(aim_file(tmp_path, lines))
    assert told[0].startswith("4 aim.frequency must be the least and the largest value") and "in that order" in told[0]
    assert told[1:] == [
        '5 aim.stroke[0] must be a length such as "150 um"; got "5 Hz", a frequency',
        "6 aim.actuators must be a list of numbers of actuators, counted from 0, such as [0, 4], each once; got [0, 0]",
        "7 aim.cycels is not known; did you mean cycles?",
        '8 aim.tolerance must be a length such as "150 um"; got 5, which has no unit',
    ]


def test_what_does_not_fit_the_case_is_told_with_the_target(tmp_path):
    told = mistakes(aim_file(tmp_path, 'actuators = [0, 2]\ntarget = ["0 um", "300 um"]\n'))
    assert told == [
        "3 aim.actuators must be numbers of actuators from 0 to 1; got 2",
        "4 aim.target must be inside the rim; got a point on it",
    ]
    up = PLATE.replace('frequency = "400 Hz"', 'frequency = "400 Hz"\ncycle = "sine"')
    (told,) = mistakes(aim_file(tmp_path, "actuators = [0]\n", up))
    assert told.endswith('goes up and down; that of actuator 0 has cycle = "sine"')
    (told,) = mistakes(aim_file(tmp_path, "", PLATFORM), (0.0, 0.0))
    assert told == "2 aim.case must have a plate on actuators; got a platform"
    (told,) = mistakes(aim_file(tmp_path, "", PLATE + "tolerence = 1e-9\n"))
    assert told.startswith("2 aim.case must be the file of a case; ") and "run.tolerence is not known" in told


def test_a_target_where_the_part_does_not_fit_is_refused(tmp_path):
    sized = case_of(tmp_path, PLATE.replace('mass = "2e-9 kg"', 'mass = "2e-9 kg"\nsize = "100 um"'))
    Task(sized, (0.0, 300e-6 - 71e-6))
    with pytest.raises(ValueError, match=r"^target must be at least 70.7107 um inside the rim, .* 70 um inside it$"):
        Task(sized, (0.0, 300e-6 - 70e-6))
    with pytest.raises(ValueError, match=r"^target must be two finite lengths"):
        Task(sized, (0.0, math.nan))


def test_what_one_actuator_cannot_reach_is_refused(tmp_path):
    one = case_of(tmp_path, ONE.replace('["75 um", "0 um"]', '["0 um", "0 um"]'))
    x, y = one.part.position
    for factor in (-1.0, 0.0, 0.3):
        Task(one, (factor * x, factor * y))
    with pytest.raises(
        ValueError, match=r"^target cannot be reached: from this start one actuator .* at 171.9 degrees"
    ):
        Task(one, (-x, y))
    still = one.model_copy(update={"part": one.part.model_copy(update={"position": (0.0, 0.0)})})
    with pytest.raises(ValueError, match="cannot be reached"):
        Task(still, (1e-5, 1e-5))
    moving = one.model_copy(update={"part": one.part.model_copy(update={"velocity": (0.0, 0.1)})})
    Task(moving, (-x, y))
    tilted = one.model_copy(update={"run": one.run.model_copy(update={"gravity": (0.0, 1.0, -9.8)})})
    Task(tilted, (-x, y))


def test_actuators_in_a_line_with_the_start_keep_the_part_on_it(tmp_path):
    case = case_of(tmp_path, PLATE)
    Task(case, (0.0, 5e-5))
    on_line = case.model_copy(update={"part": case.part.model_copy(update={"position": (-1.4e-4, 0.0)})})
    Task(on_line, (0.0, 4e-7))
    with pytest.raises(ValueError, match=r"these 2 actuators .* at 0 degrees from x, and the target is 50 um off it"):
        Task(on_line, (0.0, 5e-5))


def test_a_rectangle_has_the_mirrors_that_its_supports_have(tmp_path):
    shape = 'shape = "rectangle"\nwidth = "400 um"\nheight = "600 um"\n'
    rectangle = PLATE.replace('shape = "disc"\nradius = "300 um"\n', shape).replace('"20 um"]', '"0 um"]')
    with pytest.raises(ValueError, match="at 0 degrees"):
        Task(case_of(tmp_path, rectangle), (0.0, 5e-5))
    uneven = rectangle.replace('cell_size = "80 um"', 'supports = { left = "clamped", top = "clamped" }')
    Task(case_of(tmp_path, uneven), (0.0, 5e-5))


def test_the_actuators_nearest_to_the_way_take_part(tmp_path):
    lattice = '[lattice]\nrows = 3\ncolumns = 3\npitch = "100 um"\nstroke = "5 um"\nfrequency = "400 Hz"\n\n'
    text = PLATE[: PLATE.index("[[actuators]]")] + lattice + PLATE[PLATE.index("[part]") :]
    case = case_of(tmp_path, text.replace('["-140 um", "20 um"]', '["-100 um", "-90 um"]'))
    assert Task(case, (1e-4, -9e-5), Settings(nearest=3)).movers == (0, 1, 2)
    assert Task(case, (-1e-4, 1e-4), Settings(nearest=3)).movers == (0, 3, 6)
    assert Task(case, (1e-4, -9e-5), Settings(nearest=20)).movers == tuple(range(9))
    assert Route(case, ((1e-4, -9e-5), (1e-4, 1e-4))).leg(1, (1e-4, -9e-5)).movers == (2, 4, 5, 8)


def test_way_points_are_checked_before_any_search(tmp_path):
    (tmp_path / "base.toml").write_text(PLATE)
    with pytest.raises(ValueError) as error:
        read_route(tmp_path / "base.toml", [(0.0, 1e-5), (4e-4, 0.0), (0.0, -3e-4)])
    assert str(error.value) == (
        "way-point 1 must be inside the rim; got a point 100 um beyond it\n"
        "way-point 2 must be inside the rim; got a point on it"
    )
    with pytest.raises(ValueError, match="through must be one way-point or more"):
        read_route(tmp_path / "base.toml", [])


@pytest.mark.parametrize(
    ("text", "place"), [("100,-50", (1e-4, -5e-5)), ("0.1 mm,50um", (1e-4, 5e-5)), (" -1e2 , +.5 ", (-1e-4, 5e-7))]
)
def test_places_are_in_micrometres_or_have_units(text, place):
    assert read_place(text, "--target") == place


@pytest.mark.parametrize("text", ["", "1", "1,2,3", "a,1", "1,", "nan,1", "1e999,0", "1 s,2"])
def test_what_is_no_place_is_refused(text):
    with pytest.raises(ValueError, match="^--target must be two lengths, x and y, such as"):
        read_place(text, "--target")
