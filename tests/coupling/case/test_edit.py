"""A case written in the words of the file of another: comments, order and units stay, and it is the same case."""

import pytest

from coupling import read_case
from coupling.case import Case, CoulombCase, scaled_case, with_index, write_edited

TEXT = """\
# Made for the shaker, see the log.
[run]
duration = "3 ms"   # six cycles
tolerance = 1e-8

[part]  # the cube
position = ["0.06 mm", "20 um"]
mass = "2 ng"

# The actuators.
[[actuators]]
frequency = "0.3 kHz"  # slow
stroke = "1 um"
position = ["0 um", "0 um"]
# Idle at first.
[[actuators]]
position = ["80 um", "0 um"]
cycle = "up"
stroke = "0.5 um"
frequency = "200 Hz"
delay = "1 ms"

# How it sticks.
[friction]
model = "coulomb"
coefficient = 0.2    # measured
adhesion = "200 nN"

[plate]
radius = "200 um"
shape = "disc"
thickness = "5 um"
youngs_modulus = "169 GPa"
poisson_ratio = 0.3
"""
RESULT = """\
# What was said.
# In two lines.

# Made for the shaker, see the log.
[run]
duration = "3 ms"   # six cycles
tolerance = 1e-8

[part]  # the cube
position = ["30 um", "20 um"]
mass = "2 ng"

# The actuators.
[[actuators]]
frequency = "600 Hz"  # slow
stroke = "4 um"
position = ["0 um", "0 um"]
# Idle at first.
[[actuators]]
position = ["80 um", "0 um"]
cycle = "up"
stroke = "2 um"
frequency = "400 Hz"
delay = "0.5 ms"

# How it sticks.
[friction]
model = "coulomb"
coefficient = 0.1    # measured
adhesion = "200 nN"

[plate]
radius = "200 um"
shape = "disc"
thickness = "5 um"
youngs_modulus = "169 GPa"
poisson_ratio = 0.3
"""


def read(folder, text, name="first.toml"):
    (folder / name).write_text(text)
    return read_case(folder / name)


def same(one, other):
    keys = [key for key in Case.model_fields if key not in ("name", "source", "lattice")]
    return all(getattr(one, key) == getattr(other, key) for key in keys)


def edited(case, like, folder, name="second.toml", said=""):
    file = write_edited(case, like, folder, folder / name, said)
    assert same(read_case(file), case)
    return file.read_text()


def moved(case):
    friction = case.friction.model_copy(update={"coefficient": 0.1})
    part = case.part.model_copy(update={"position": (30e-6, 20e-6)})
    return scaled_case(case, 2.0, 4.0, shortly=True).model_copy(update={"friction": friction, "part": part})


def test_only_the_values_that_change_are_written(tmp_path):
    like = read(tmp_path, TEXT)
    assert edited(moved(like), like, tmp_path, said="What was said.\nIn two lines.") == RESULT
    assert edited(like, like, tmp_path, "third.toml") == TEXT


def test_a_new_key_stands_below_the_others_of_its_table(tmp_path):
    like = read(tmp_path, TEXT)
    size = like.part.model_copy(update={"size": 1e-4})
    first = like.actuators[0].model_copy(update={"cycle": "sine", "ramp": 3.0})
    case = like.model_copy(update={"part": size, "actuators": (first, like.actuators[1])})
    expected = TEXT.replace('mass = "2 ng"\n', 'mass = "2 ng"\nsize = "100 um"\n').replace(
        'position = ["0 um", "0 um"]\n', 'position = ["0 um", "0 um"]\ncycle = "sine"\nramp = 3.0\n'
    )
    assert edited(case, like, tmp_path) == expected


def test_a_key_that_has_no_value_any_more_goes(tmp_path):
    paper = '[friction]  # of the paper\nmodel = "kogut-etsion"\npreset = "paper"\n\n'
    like = read(tmp_path, TEXT.replace(TEXT[TEXT.index("[friction]") : TEXT.index("[plate]")], paper))
    case = like.model_copy(update={"friction": with_index(like.friction, 3.0)})
    text = edited(case, like, tmp_path)
    assert "preset" not in text and "plasticity_index = 3.0\n" in text and "# of the paper" in text


LATTICE = '[lattice]\nrows = 2\ncolumns = 2\npitch = "60 um"\nstroke = "1 um"\nfrequency = "300 Hz"\n'


def test_a_lattice_is_written_anew_where_its_drives_change(tmp_path):
    text = TEXT[: TEXT.index("# The actuators.")] + LATTICE + TEXT[TEXT.index("# How it sticks.") :]
    like = read(tmp_path, text)
    scaled = edited(scaled_case(like, 2.0, 1.0), like, tmp_path)
    assert scaled.count("[[actuators]]") == 4 and "lattice" not in scaled
    slick = like.model_copy(update={"friction": CoulombCase(coefficient=0.05, adhesion=2e-7)})
    assert edited(slick, like, tmp_path, "third.toml") == text.replace("coefficient = 0.2 ", "coefficient = 0.05 ")


@pytest.mark.parametrize("folder", ["", "deep/er"])
def test_files_beside_the_case_are_found_from_the_new_folder(tmp_path, folder):
    motion = "time [ms], x [um]\n" + "".join(f"{k}, {k % 3}\n" for k in range(12))
    (tmp_path / "shaker.csv").write_text(motion)
    law = "load [uN], limit [nN]\n-1, 4\n0, 18.7\n2.2, 35\n5, 52\n"
    (tmp_path / "law.csv").write_text(law)
    tables = '[plate]\nshape = "platform"\nmotion = "shaker.csv"  # measured\n'
    tables += '[friction]\nmodel = "table"\nfile = "law.csv"\n'
    like = read(tmp_path, TEXT[: TEXT.index("# The actuators.")] + tables)
    part = like.part.model_copy(update={"position": (1e-5, 0.0)})
    file = write_edited(like.model_copy(update={"part": part}), like, tmp_path, tmp_path / folder / "second.toml")
    again = read_case(file)
    assert again.part == part and again.friction == like.friction
    assert again.plate.read_motion == like.plate.read_motion
    assert "# measured" in file.read_text() and "# the cube" in file.read_text() and "law.csv" in file.read_text()


def test_a_case_made_in_python_is_written_as_ever(tmp_path):
    like = read(tmp_path, TEXT).model_copy(update={"source": None})
    assert "#" not in edited(moved(like), like, tmp_path)
