"""The points of a study: each a pure function of its index, and the cases that they lead to."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sweeps import LATTICE, PLATE, PLATFORM, written

from active_surface.parameter import Parameter
from active_surface.studies import read_study, sweep_file
from active_surface.studies.axes import spaced
from coupling import InputError, ground_key, read_case

TWO = """\
[[axes]]
field = "actuators.0.frequency"
range = ["100 Hz", "400 Hz"]
spacing = "logarithmic"
[[axes]]
field = "friction.limit"
values = ["10 nN", "20 nN", "30 nN"]
"""


@pytest.mark.parametrize("sampling", ["random", "sobol"])
def test_drawn_points_do_not_depend_on_how_many_are_asked_for(tmp_path, sampling):
    points = read_study(written(tmp_path, f'sampling = "{sampling}"\npoints = 77\nseed = 3\n{TWO}')).points
    at_once = points.values(range(77))
    assert at_once == [points.values([k])[0] for k in range(77)]
    assert at_once == points.values(range(5)) + points.values(range(5, 40)) + points.values(range(40, 77))
    frequency, limit = np.array(at_once).T
    assert (frequency.min() >= 100) and (frequency.max() < 400) and abs(np.median(frequency) - 200) < 30
    assert sorted(set(limit)) == [1e-8, 2e-8, 3e-8]
    other = read_study(written(tmp_path, f'sampling = "{sampling}"\npoints = 77\nseed = 4\n{TWO}')).points
    assert other.values(range(77)) != at_once


def test_repeats_share_their_point_and_start_apart_within_the_jitter(tmp_path):
    points = read_study(
        written(tmp_path, 'sampling = "random"\npoints = 40\nrepeats = 50\njitter = "2 um"\n' + TWO)
    ).points
    assert len(points) == 2000 and points.dimensions == {"point": 40, "repeat": 50}
    assert points.values(range(49, 51)) == [points.values(range(1))[0], points.values(range(50, 51))[0]]
    away = points.displacements(range(2000))
    assert np.array_equal(away[700:703], points.displacements(range(700, 703)))
    radii = np.hypot(*away.T)
    assert radii.max() < 2e-6 and abs((radii**2).mean() / 2e-12 - 1) < 0.1
    assert np.abs(away.mean(axis=0)).max() < 1e-7 and len(np.unique(away[:, 0])) == 2000


def test_a_list_goes_along_all_axes_at_once(tmp_path):
    listed = TWO.replace('"logarithmic"', '"logarithmic"\ncount = 3')
    points = read_study(written(tmp_path, f'sampling = "list"\n{listed}')).points
    assert points.dimensions == {"point": 3}
    assert points.values(range(3)) == [(100.0, 1e-8), (pytest.approx(200.0), 2e-8), (400.0, 3e-8)]


@given(st.integers(2, 40), st.integers(2, 9), st.floats(1e-9, 1e9), st.floats(1e-9, 1e9), st.booleans())
def test_equal_fractions_of_a_range_are_equal_to_the_last_bit(count, times, low, high, logarithmic):
    few, many = (spaced(Parameter(None, low, high, logarithmic), number) for number in (count, (count - 1) * times + 1))
    assert many[::times] == few and (few[0], few[-1]) == (low, high)
    space = np.geomspace if logarithmic else np.linspace
    assert many == pytest.approx(space(low, high, len(many)).tolist(), rel=1e-12, abs=1e-12 * max(low, high))


UNEVEN = LATTICE.replace('"100 um"', '["100 um", "9 um"]')
CHANGED = [
    (PLATE, "actuators.*.stroke", '"30 um"', 'stroke = "60 um"', 'stroke = "30 um"'),
    (PLATE, "actuators.1.frequency", '"350 Hz"', 'frequency = "300 Hz"', 'frequency = "350 Hz"'),
    (PLATE, "actuators.0.position.1", '"7 um"', '["-75 um", "0 um"]', '["-75 um", "7 um"]'),
    (PLATE, "actuators.1.stiffness", '"1e4 N/m"', '"300 Hz"', '"300 Hz"\nstiffness = "1e4 N/m"'),
    (PLATE, "plate.supports", '"simply-supported"', "cell_size", 'supports = "simply-supported"\ncell_size'),
    (PLATE, "plate.thickness", '"6 um"', 'thickness = "5 um"', 'thickness = "6 um"'),
    (PLATE, "part.position.0", '"-120 um"', '"-140 um"', '"-120 um"'),
    (PLATE, "part.velocity.1", '"1 mm/s"', "[friction]", 'velocity = ["0 m/s", "1 mm/s"]\n[friction]'),
    (PLATE, "friction.limit", '"1 uN"', '"40 nN"', '"1 uN"'),
    (PLATE, "run.duration", '"7 ms"', '"5 ms"', '"7 ms"'),
    (PLATE, "run.gravity", '"1.6 m/s^2"', '"5 ms"', '"5 ms"\ngravity = "1.6 m/s^2"'),
    (PLATFORM, "plate.motion.x.frequency", '"300 Hz"', '"200 Hz"', '"300 Hz"'),
    (LATTICE, "lattice.pitch", '"90 um"', '"100 um"', '"90 um"'),
    (LATTICE, "lattice.columns", "2", "columns = 3", "columns = 2"),
    (LATTICE, "lattice.centre.0", '"20 um"', "[lattice]", '[lattice]\ncentre = ["20 um", "0 um"]'),
    (LATTICE, "lattice.where", '"column > 0"', "[lattice]", '[lattice]\nwhere = "column > 0"'),
    (UNEVEN, "lattice.pitch.0", '"80 um"', '["100 um", "9 um"]', '["80 um", "9 um"]'),
]


@pytest.mark.parametrize(("text", "field", "value", "old", "new"), CHANGED, ids=lambda text: str(text)[:24])
def test_the_case_at_a_point_is_that_of_a_file_with_its_values(tmp_path, text, field, value, old, new):
    study = read_study(written(tmp_path, f'[[axes]]\nfield = "{field}"\nvalues = [{value}]\n', text))
    case = study.case_at(study.points.values(range(1))[0])
    (tmp_path / "changed.toml").write_text(text.replace(old, new))
    expected = read_case(tmp_path / "changed.toml")
    assert case.model_dump(exclude={"name", "source"}) == expected.model_dump(exclude={"name", "source"})


@pytest.mark.parametrize(
    ("field", "value", "old"),
    [
        ("rows", "2", "rows = 1"),
        ("columns", "2", "columns = 3"),
        ("pitch", '"90 um"', 'pitch = "100 um"'),
        ("stroke", '"7 um"', 'stroke = "5 * (1 + column) um"'),
    ],
)
def test_a_lattice_alone_is_made_anew_and_none_of_its_old_actuators_stay(tmp_path, field, value, old):
    alone = LATTICE[: LATTICE.index("[[actuators]]")] + LATTICE[LATTICE.index("[lattice]") :]
    study = read_study(written(tmp_path, f'[[axes]]\nfield = "lattice.{field}"\nvalues = [{value}]\n', alone))
    (values,) = study.points.values(range(1))
    (tmp_path / "same.toml").write_text(alone.replace(old, f"{field} = {value}"))
    assert study.case_at(values).actuators == read_case(tmp_path / "same.toml").actuators


def test_an_actuator_that_a_lattice_made_may_be_varied_by_itself(tmp_path):
    study = read_study(written(tmp_path, '[[axes]]\nfield = "actuators.3.stroke"\nvalues = ["7 um"]\n', LATTICE))
    case = study.case_at((7e-6,))
    assert [actuator.stroke for actuator in case.actuators] == pytest.approx([1e-6, 5e-6, 1e-5, 7e-6])


def test_points_with_the_same_plate_share_their_ground_and_others_do_not(tmp_path):
    study = read_study(
        written(
            tmp_path,
            '[[axes]]\nfield = "plate.thickness"\nvalues = ["5 um", "6 um"]\n'
            + TWO.replace("spacing", "count = 2\nspacing"),
        )
    )
    grounds = [ground_key(study.case_at(values)) for values in study.points.values(range(len(study.points)))]
    assert grounds == grounds[:1] * 6 + grounds[6:7] * 6 and len(set(grounds)) == 2


def test_a_contradiction_at_one_point_is_found_there(tmp_path):
    coulomb = PLATE.replace('"constant"\nlimit = "40 nN"', '"coulomb"\ncoefficient = 0.2')
    study = read_study(
        written(
            tmp_path,
            '[[axes]]\nfield = "friction.coefficient"\nvalues = [0.1, 0.3]\n'
            '[[axes]]\nfield = "friction.static_coefficient"\nvalues = [0.2, 0.4]\n',
            coulomb,
        )
    )
    for values in study.points.values(range(4)):
        if values == (0.3, 0.2):
            with pytest.raises(InputError, match="must be at least coefficient"):
                study.case_at(values)
        else:
            assert study.case_at(values).friction.coefficient == values[0]


@given(st.lists(st.integers(1, 5), min_size=1, max_size=4), st.integers(1, 30))
@settings(max_examples=200, deadline=None)
def test_slabs_cover_an_array_in_order(shape, at_once):
    array = np.arange(np.prod(shape)).reshape(shape)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(sweep_file, "AT_ONCE", at_once)
        pieces = [array[slab].ravel() for slab in sweep_file.slabs(shape)]
    assert np.array_equal(np.concatenate(pieces), array.ravel())
    assert max(map(len, pieces)) <= at_once
