"""Study files: what they say, and every mistake in one at once."""

import pytest
from sweeps import LATTICE, PLATE, PLATFORM, written

from active_surface.studies import read_study
from coupling import CaseError
from coupling.case import PartCase

STROKE = '[[axes]]\nfield = "actuators.*.stroke"\nvalues = ["10 um", "20 um"]\n'


def mistakes(tmp_path, study, case=PLATE):
    with pytest.raises(CaseError) as error:
        read_study(written(tmp_path, study, case))
    return [f"{problem.line} {problem.field} {problem.message}" for problem in error.value.problems]


def test_axes_values_are_in_si_units(tmp_path):
    study = read_study(
        written(
            tmp_path,
            STROKE + '[[axes]]\nfield = "run.gravity"\nname = "g"\nrange = ["1 m/s^2", "9 m/s^2"]\ncount = 3\n',
        )
    )
    assert study.points.dimensions == {"actuators.*.stroke": 2, "g": 3}
    assert [axis.values for axis in study.points.axes] == [(1e-5, 2e-5), (1.0, 5.0, 9.0)]
    assert study.points.values(range(2, 4)) == [(1e-5, 9.0), (2e-5, 1.0)]
    assert study.points.axes[0].field.locations == (("actuators", 0, "stroke"), ("actuators", 1, "stroke"))
    assert (study.name, study.case.name) == ("study", "base")


def test_axes_of_the_plate_vary_slowest(tmp_path):
    thickness = '[[axes]]\nfield = "plate.thickness"\nvalues = ["5 um", "6 um"]\n'
    assert list(read_study(written(tmp_path, STROKE + thickness)).points.dimensions) == [
        "plate.thickness",
        "actuators.*.stroke",
    ]


@pytest.mark.parametrize(
    ("field", "message"),
    [
        ("actuators.0.frequenzy", "actuators[0] has no frequenzy; did you mean frequency?"),
        ("actuatos.0.stroke", "the case has no actuatos; did you mean actuators?"),
        ("actuators.2.stroke", "its actuators are counted from 0 to 1, * for all; got 2"),
        ("part.", 'part has no ""; it has ' + ", ".join(PartCase.model_fields)),
        ("actuators.stroke", "its actuators are counted from 0 to 1, * for all; got stroke"),
        ("part.position", "must be a single value; got part.position, which is a list or table; name one in it"),
        ("part.position.2", "its part.position are counted from 0 to 1, * for all; got 2"),
        ("part", "must be a single value; got part, which is a list or table; name one in it"),
        ("friction.model.x", "its friction.model is a single value"),
        ("lattice.stroke", "it has no [lattice]"),
        ("run.frames", "must be a field that changes a path; got run.frames, which a sweep does not use"),
    ],
)
def test_a_field_that_there_is_not_is_told(tmp_path, field, message):
    (told,) = mistakes(tmp_path, f'[[axes]]\nfield = "{field}"\nvalues = [1]\n')
    assert told.startswith("4 axes[0].field must be") and told.endswith(message)


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        (
            'values = ["1 um", "300 Hz"]',
            '5 axes[0].values[1] must be a length such as "150 um"; got "300 Hz", a frequency',
        ),
        ("values = [3]", '5 axes[0].values[0] must be a length such as "150 um"; got 3, which has no unit'),
        ("values = []", '5 axes[0].values must be a list of values such as ["300 Hz", "400 Hz"]; got []'),
        ('range = ["1 um"]', 'must be the first and the last value, such as ["200 Hz", "600 Hz"]; got ["1 um"]'),
        ('range = ["1 um", "1 um"]\ncount = 2', "axes[0].range must have a last value that differs from the first"),
        (
            'range = ["1 um", "2 um"]',
            'axes[0].count is missing; with sampling = "grid" a range needs a count of values',
        ),
        ('range = ["1 um", "2 um"]\ncount = 1', "axes[0].count must be at least 2 for a range; got 1"),
        ('values = ["1 um", "1000 nm"]', "must differ from each other; got 1e-06 m twice"),
        ('values = ["1 um"]\ncount = 3', "axes[0].count must not be given with values; it belongs to a range"),
        ('values = ["1 um"]\nrange = ["1 um", "2 um"]', "axes[0].range must not be given with values"),
        ("", "axes[0].values is missing; give a list of values, or a range and a count"),
        (
            'range = ["0 um", "2 um"]\ncount = 3\nspacing = "logarithmic"',
            'must have values above 0 with spacing = "logarithmic"',
        ),
        ('values = ["1 um"]\nname = "point"', 'any of _ . * -, and none of the results\' own names; got "point"'),
        ('values = ["1 um"]\nname = "end_x"', 'none of the results\' own names; got "end_x"'),
        ('values = ["1 um"]\nname = "a/b"', 'none of the results\' own names; got "a/b"'),
        ('range = ["1 um", "2 um"]\ncount = 1_000_000_000', "axes[0].count must be at most 1e+06; got 1000000000"),
        ('value = ["1 um"]', "axes[0].value is not known; did you mean values?"),
    ],
)
def test_values_that_do_not_fit_are_told(tmp_path, keys, message):
    (told,) = mistakes(tmp_path, f'[[axes]]\nfield = "actuators.0.stroke"\n{keys}\n')
    assert told.endswith(message)


def test_a_value_without_a_unit_keeps_its_digits(tmp_path):
    (told,) = mistakes(tmp_path, '[[axes]]\nfield = "plate.poisson_ratio"\nvalues = [0.1, 0.1]\n')
    assert told.endswith("must differ from each other; got 0.1 twice")


@pytest.mark.parametrize(
    ("study", "message"),
    [
        ('sampling = "sobol"\n', '1 study.points is missing; with sampling = "sobol" it must be a whole number'),
        ("points = 5\n", '3 study.points must not be given with sampling = "grid", whose axes tell the points'),
        ("repeats = 3\n", '3 study.repeats must not be given without a jitter such as "1 um": the paths would all be'),
        ('jitter = "3 Hz"\n', '3 study.jitter must be a length such as "150 um"; got "3 Hz", a frequency'),
        ('sampling = "dice"\n', 'study.sampling must be "grid", "list", "random" or "sobol"; got "dice"'),
        ("seed = -1\n", "study.seed must be at least 0; got -1"),
        ("colour = 1\n", "study.colour is not known; [study] has case, sampling, points, repeats, jitter, seed"),
    ],
)
def test_what_is_wrong_with_the_sampling_is_told(tmp_path, study, message):
    told = mistakes(tmp_path, study + STROKE)
    assert len(told) == 1 and message in told[0]


def test_all_mistakes_are_told_at_once(tmp_path):
    told = mistakes(
        tmp_path,
        STROKE + '[[axes]]\nfield = "actuators.1.stroke"\nvalues = ["1 um"]\n'
        '[[axes]]\nfield = "run.duraton"\nvalues = ["1 ms"]\n'
        '[[axes]]\nfield = "part.mass"\nvalues = ["1 m", "-1 kg"]\n',
    )
    assert [line.split()[1] for line in told] == [
        "axes[1].field",
        "axes[2].field",
        "axes[3].values[0]",
        "axes[3].values[1]",
    ]
    assert "actuators.1.stroke is varied by the axis actuators.*.stroke already" in told[0]
    assert told[3].endswith('must be greater than 0; got "-1 kg"')
    told = mistakes(
        tmp_path,
        "seed = -1\n" + STROKE + '[[axes]]\nfield = "run.duraton"\nrange = ["1 ms", "2 ms"]\ncount = 7.5\n'
        '[[axes]]\nfield = "run.duraton"\nvalues = ["1 ms"]\n[[axes]]\nfield = "part.mass"\nvalues = ["1 V", "1 kg"]\n'
        '[map]\nthreshold = "distance > 1"\n',
    )
    assert [line.split()[1] for line in told] == [
        "study.seed",
        "axes[1].count",
        "axes[2].field",
        "axes[3].values[0]",
        "map.threshold",
    ]


@pytest.mark.parametrize("first", [True, False])
def test_an_axis_over_part_of_what_another_one_varies_is_a_mistake(tmp_path, first):
    axes = [f'[[axes]]\nfield = "run.gravity{item}"\nvalues = ["9 m/s^2"]\n' for item in ("", ".0")]
    tilted = PLATE + 'gravity = ["1 m/s^2", "0 m/s^2", "9.8 m/s^2"]\n'
    (told,) = mistakes(tmp_path, "".join(axes if first else axes[::-1]), tilted)
    already = f"run.gravity.0 is varied by the axis run.gravity{'' if first else '.0'} already"
    assert told.endswith(f"axes[1].field must be varied by one axis only; {already}")


def test_a_file_without_axes_and_one_without_a_case_are_told(tmp_path):
    assert mistakes(tmp_path, "") == ["None axes is missing; it must be a table, written [[axes]]"]
    (told,) = mistakes(tmp_path, '[study]\ncase = "nowhere.toml"\n' + STROKE)
    assert "2 study.case must be the file of a case; " in told and "nowhere.toml" in told
    (told,) = mistakes(tmp_path, '[study]\ncase = "a\\u0000"\n' + STROKE)
    assert "2 study.case must be the file of a case; " in told and "must have a name that can be printed" in told


def test_missing_keys_are_told_with_what_they_must_be(tmp_path):
    told = mistakes(tmp_path, '[study]\n[[axes]]\nvalues = ["1 um"]\n')
    assert told == [
        '1 study.case is missing; it must be the name of a case file such as "two_actuators.toml"',
        '2 axes[0].field is missing; it must be the path of a field such as "actuators.0.frequency"',
    ]


def test_mistakes_of_the_base_case_are_told(tmp_path):
    (told,) = mistakes(tmp_path, STROKE, PLATE.replace('"169 GPa"', '"169 Hz"').replace("mass =", "mas ="))
    assert "2 mistakes" in told and "plate.youngs_modulus" in told and "part.mas" in told


def test_a_base_case_with_fixed_steps_is_refused(tmp_path):
    (told,) = mistakes(tmp_path, STROKE, PLATE + 'scheme = "fixed"\n')
    assert told.endswith('must have run.scheme = "events", by which sweeps go; got "fixed"')


def test_a_list_has_as_many_values_on_each_axis(tmp_path):
    (told,) = mistakes(
        tmp_path, 'sampling = "list"\n' + STROKE + '[[axes]]\nfield = "part.mass"\nvalues = ["1e-9 kg"]\n'
    )
    assert told.endswith('axes[1].values must be as many as those of the first axis with sampling = "list", 2')


def test_a_start_that_is_always_off_the_plate_is_a_mistake(tmp_path):
    off = '[[axes]]\nfield = "part.position.0"\nvalues = ["400 um", "500 um"]\n'
    (told,) = mistakes(tmp_path, STROKE + off)
    assert "lead to a case that cannot be run at every point: part.position must be inside the rim" in told
    assert told.endswith("got a point 100.5 um beyond it")
    assert read_study(written(tmp_path, STROKE + off.replace("400 um", "200 um")))


def test_a_value_that_contradicts_the_case_everywhere_is_a_mistake(tmp_path):
    (told,) = mistakes(tmp_path, '[[axes]]\nfield = "actuators.0.force"\nvalues = ["1 mN"]\n')
    assert "actuators[0].force must not be given with a stroke" in told


@pytest.mark.parametrize(
    ("field", "value", "said"),
    [
        ("friction.model", "constant", "selects which other keys exist"),
        ("plate.shape", "disc", "selects which other keys exist"),
        ("plate.mesh", "a.msh", "names a file"),
        ("plate.motion", "a.csv", "names a file"),
        ("friction.file", "a.csv", "names a file"),
    ],
)
def test_files_and_what_decides_on_other_keys_cannot_be_varied(tmp_path, field, value, said):
    (told,) = mistakes(tmp_path, f'[[axes]]\nfield = "{field}"\nvalues = ["{value}"]\n')
    assert told.endswith(f"axes[0].field cannot be varied: {field} {said}")


@pytest.mark.parametrize("made", ['lattice.columns"\nvalues = [2, 3]', 'lattice.stroke"\nvalues = ["4 um", "8 um"]'])
@pytest.mark.parametrize(
    ("field", "value"), [("*.stroke", "7 um"), ("1.stroke", "7 um"), ("2.position.1", "1 um"), ("0.stroke", "")]
)
@pytest.mark.parametrize("first", [True, False])
def test_an_axis_over_what_another_axis_makes_anew_is_a_mistake(tmp_path, made, field, value, first):
    axes = [f'[[axes]]\nfield = "{made}\n', f'[[axes]]\nfield = "actuators.{field}"\nvalues = ["{value or "9 um"}"]\n']
    text = "".join(axes if first else axes[::-1])
    if value:
        (told,) = mistakes(tmp_path, text, LATTICE)
        over = made.split('"')[0]
        message = f"must not vary actuators from 1 on: the axis over {over} makes them"
        assert told.endswith(f"axes[{1 if first else 0}].field {message}")
    else:
        assert len(read_study(written(tmp_path, text, LATTICE)).points) == 2
    alone = LATTICE[: LATTICE.index("[[actuators]]")] + LATTICE[LATTICE.index("[lattice]") :]
    (told,) = mistakes(tmp_path, text, alone)
    assert "must not vary actuators from 0 on: the axis over lattice." in told


def test_a_table_is_right_before_its_values_are_read(tmp_path):
    told = mistakes(
        tmp_path,
        '[[axes]]\nfield = "actuators.*.stroke"\nname = "a b"\nvalues = ["10 um", 5, "ten um"]\n'
        '[[axes]]\nfield = "part.mass"\ncount = 3\nrange = ["1 Hz", "2 ug"]\nspacing = "log"\n'
        '[[axes]]\nfield = "actuators.0.stroke"\nvalues = ["1 parsec?"]\n',
    )
    assert [line.split()[1] for line in told] == ["axes[0].name", "axes[1].spacing", "axes[2].values[0]"]


def test_a_value_that_is_listed_twice_is_found_among_many(tmp_path):
    listed = [*range(1, 60_000), 7]
    (told,) = mistakes(tmp_path, f'[[axes]]\nfield = "actuators.0.cycles"\nvalues = {listed}\n')
    assert "got 7 twice" in told


def test_fields_of_lattices_platforms_and_texts_are_found(tmp_path):
    study = read_study(written(tmp_path, '[[axes]]\nfield = "lattice.pitch"\nvalues = ["90 um", "80 um"]\n', LATTICE))
    assert study.points.axes[0].field.unit == "m"
    study = read_study(
        written(tmp_path, '[[axes]]\nfield = "plate.motion.x.cycle"\nvalues = ["up", "sine"]\n', PLATFORM)
    )
    assert (study.points.axes[0].values, study.points.axes[0].field.unit) == (("up", "sine"), "")
    study = read_study(written(tmp_path, '[[axes]]\nfield = "actuators.0.cycles"\nvalues = [1, 2]\n'))
    assert study.points.axes[0].values == (1, 2)
    (told,) = mistakes(tmp_path, '[[axes]]\nfield = "actuators.0.cycles"\nrange = [1, 4]\ncount = 4\n')
    assert "has no values in between; list its values" in told
    (told,) = mistakes(tmp_path, '[[axes]]\nfield = "lattice.stroke"\nvalues = ["column um"]\n', LATTICE)
    assert 'must be one number; got "column um"' in told
    (told,) = mistakes(tmp_path, '[[axes]]\nfield = "plate.supports"\nvalues = [{ rim = "free" }]\n')
    assert "must be one text; got" in told
    (told,) = mistakes(tmp_path, '[[axes]]\nfield = "lattice.pitch.0"\nvalues = ["9 um"]\n', LATTICE)
    assert "its lattice.pitch is a single value" in told


def test_a_table_has_times_and_heights(tmp_path):
    rows = 'table = [["0 ms", "0 um"], ["1 ms", "50 um"], ["3 ms", "0 um"]]\n'
    text = PLATE.replace('stroke = "60 um"\nfrequency = "400 Hz"\n', rows)
    axis = '[[axes]]\nfield = "actuators.0.table.1.{}"\nvalues = ["{}"]\n'
    for item, value, unit, read in ((0, "2 ms", "s", 2e-3), (1, "20 um", "m", 2e-5)):
        study = read_study(written(tmp_path, axis.format(item, value), text))
        assert (study.points.axes[0].field.unit, study.points.axes[0].values) == (unit, (pytest.approx(read),))
    (told,) = mistakes(tmp_path, axis.format(1, "0.02 ms"), text)
    assert told.endswith('must be a length such as "150 um"; got "0.02 ms", a time')


def test_a_file_that_is_no_toml_is_told(tmp_path):
    assert "is not valid TOML" in mistakes(tmp_path, "[study\n")[0]
