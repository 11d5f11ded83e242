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
NEW = {
    '"0.06 mm"': '"0.03 mm"', '"0.3 kHz"': '"0.6 kHz"', '"1 um"': '"4 um"', '"0.5 um"': '"2 um"',
    '"200 Hz"': '"400 Hz"', '"1 ms"': '"0.5 ms"', "= 0.2 ": "= 0.1 ",
}  # fmt: skip


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
    result = "# What was said.\n# In two lines.\n\n" + TEXT
    for old, new in NEW.items():
        assert result.count(old) == 1
        result = result.replace(old, new)
    assert edited(moved(like), like, tmp_path, said="What was said.\nIn two lines.") == result
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


LATTICE = """\
# Nine in a square.
[lattice]  # of piezos
rows = 3
columns = 3
pitch = "0.06 mm"      # apart
stroke = "1 um"
frequency = "0.3 kHz"  # slow
phase = "15 * (row + column) deg"

"""
OF_LATTICE = TEXT[: TEXT.index("# The actuators.")] + LATTICE + TEXT[TEXT.index("# How it sticks.") :]


def test_a_lattice_takes_what_most_of_its_actuators_have(tmp_path):
    like = read(tmp_path, OF_LATTICE)
    slick = like.model_copy(update={"friction": CoulombCase(coefficient=0.05, adhesion=2e-7)})
    assert edited(slick, like, tmp_path) == OF_LATTICE.replace("coefficient = 0.2 ", "coefficient = 0.05 ")
    faster = OF_LATTICE.replace('"0.3 kHz"', '"0.6 kHz"')
    assert edited(scaled_case(like, 2.0, 1.0), like, tmp_path) == faster
    level = like.vary({"actuators.*.phase": "0.125 turn", "actuators.*.delay": "1 ms"})
    expected = OF_LATTICE.replace('"15 * (row + column) deg"\n', '"45 deg"\ndelay = "1 ms"\n')
    assert edited(level, like, tmp_path) == expected
    drive = OF_LATTICE[OF_LATTICE.index('stroke = "1 um"') : OF_LATTICE.index("# How")]
    heights = OF_LATTICE.replace(drive, 'table = [["0 ms", "0 um"], ["1 ms", "9 um"]]  # up\n\n')
    like = read(tmp_path, heights)
    higher = like.vary({"actuators.*.table.1.1": "12 um"})
    assert edited(higher, like, tmp_path) == heights.replace("9 um", "12 um")


OWN = """
[[actuators]]
position = ["-0.06 mm", "-0.06 mm"]
stroke = "2.5 um"
frequency = "0.3 kHz"

[[actuators]]
position = ["0.01 mm", "0 mm"]
stroke = "1 um"
frequency = "0.3 kHz"
phase = "30 deg"
"""


@pytest.mark.parametrize("condition", ["", 'where = "x + y < 100e-6"  # but one\n'])
def test_actuators_that_leave_a_lattice_get_tables_of_their_own(tmp_path, condition):
    text = OF_LATTICE.replace('deg"\n\n', f'deg"\n{condition}\n')
    like = read(tmp_path, text)
    left = "(row != 0 or column != 0) and (row != 1 or column != 1)"
    where = condition.replace('"x + y < 100e-6"', f'"(x + y < 100e-6) and {left}"') or f'where = "{left}"\n'
    expected = text.replace(f'deg"\n{condition}', f'deg"\n{where}{OWN}')
    some = like.vary({"actuators.0.stroke": "2500 nm", "actuators.4.position.0": "10 um"})
    file = write_edited(some, like, tmp_path, tmp_path / "second.toml")
    assert file.read_text() == expected
    again = read_case(file)
    assert len(again.actuators) == len(like.actuators) and again.part == like.part
    back = edited_places(write_edited(like, again, tmp_path, tmp_path / "third.toml"))
    assert back == edited_places(tmp_path / "first.toml")  # taken back after it was saved
    assert (tmp_path / "third.toml").read_text().startswith(text[: text.index("phase")])


def edited_places(file):
    return sorted(tuple(round(c, 15) for c in one.position) for one in read_case(file).actuators)


def test_a_lattice_of_which_little_is_left_becomes_actuators_where_it_stood(tmp_path):
    like = read(tmp_path, OF_LATTICE)
    case = like.vary({f"actuators.{k}.stroke": f"{k + 1} um" for k in range(9)})
    file = write_edited(case, like, tmp_path, tmp_path / "second.toml")
    before, after = OF_LATTICE.split(LATTICE[LATTICE.index("[lattice]") :].rstrip("\n"))
    text = file.read_text()
    assert text.startswith(before) and text.endswith(after) and "lattice" not in text
    assert text.count("[[actuators]]") == 9 and 'position = ["-0.06 mm", "-0.06 mm"]\nstroke = "1 um"' in text
    assert [one.stroke for one in read_case(file).actuators] == [one.stroke for one in case.actuators]


WRITTEN = """\
plate = { shape = "disc", radius = "0.3 mm", thickness = "5 um", youngs_modulus = "169 GPa", poisson_ratio = 0.3 }
run.duration = '3.0 ms' # tabs\tand all
run.gravity = ["0 m/s^2", "0 m/s^2", "9.8 m/s^2"]

  [[actuators]]
  position = [
    "0.00 mm",  # x
    '10.0 um',  # y
  ]
  stroke   =  "1e-6 m"
  frequency = "54_000 1/min"
  phase = "0.25 turn"
[friction]
model = "kogut-etsion"
preset = "paper"
[[actuators]]
position = ["50 um", "50 um"]
table = [["0 ms", "0 um"], ["1 ms", "0.001 mm"]]  # up
[part]
mass = "2 ng"
position = ["80 um", "-0.1 mm"]"""
CHANGES = [
    ({"actuators.0.position.0": "20 um"}, '"0.00 mm",', '"0.02 mm",'),
    ({"actuators.0.position.1": "20 nm"}, "'10.0 um',", '"0.02 um",'),
    ({"actuators.0.stroke": "2 um"}, '"1e-6 m"', '"2e-6 m"'),
    ({"actuators.0.frequency": "1 kHz"}, '"54_000 1/min"', '"60000 1/min"'),
    ({"actuators.0.phase": "45 deg"}, '"0.25 turn"', '"0.125 turn"'),
    ({"actuators.0.phase": "1 rad"}, '"0.25 turn"', '"1 rad"'),
    ({"actuators.0.delay": "1 ms"}, '  phase = "0.25 turn"\n', '  phase = "0.25 turn"\n  delay = "1 ms"\n'),
    ({"actuators.1.table.1.1": "2 um"}, '"0.001 mm"', '"0.002 mm"'),
    ({"part.mass": "2 g"}, '"2 ng"', '"0.002 kg"'),
    ({"part.position.1": "-30 um"}, '"-0.1 mm"]', '"-0.03 mm"]'),
    ({"part.squeeze": "1 uN"}, '"-0.1 mm"]', '"-0.1 mm"]\nsqueeze = "1 uN"\n'),
    ({"plate.pressure": "3 Pa"}, "poisson_ratio = 0.3 }", 'poisson_ratio = 0.3, pressure = "3 Pa" }'),
    ({"plate.thickness": "0.004 mm"}, '"5 um"', '"4 um"'),
    ({"run.duration": "4 ms"}, "'3.0 ms'", '"4 ms"'),
    ({"run.gravity.2": "-3 m/s^2"}, '"9.8 m/s^2"]', '"-3 m/s^2"]'),
    ({"friction.preset": None, "friction.plasticity_index": 3.0}, 'preset = "paper"', "plasticity_index = 3.0"),
]


@pytest.mark.parametrize("ends", ["\n", "\r\n"])
@pytest.mark.parametrize(("changes", "old", "new"), CHANGES)
def test_all_else_stays_to_the_byte(tmp_path, changes, old, new, ends):
    (tmp_path / "first.toml").write_bytes(WRITTEN.replace("\n", ends).encode())
    like = read_case(tmp_path / "first.toml")
    edited(like.vary(changes), like, tmp_path)
    assert WRITTEN.count(old) == 1
    assert (tmp_path / "second.toml").read_bytes() == WRITTEN.replace(old, new).replace("\n", ends).encode()


@pytest.mark.parametrize("folder", ["", "deep/er"])
def test_files_beside_the_case_are_found_from_the_new_folder(tmp_path, folder):
    motion = "time [ms], x [um]\n" + "".join(f"{k}, {k % 3}\n" for k in range(12))
    (tmp_path / "shaker.csv").write_text(motion)
    law = "load [uN], limit [nN]\n-1, 4\n0, 18.7\n2.2, 35\n5, 52\n"
    (tmp_path / "law.csv").write_text(law)
    tables = '[plate]\nshape = "platform"\nmotion = "./shaker.csv"  # measured\n'
    tables += '[friction]\nmodel = "table"\nfile = "law.csv"\n'
    like = read(tmp_path, TEXT[: TEXT.index("# The actuators.")] + tables)
    part = like.part.model_copy(update={"position": (1e-5, 0.0)})
    file = write_edited(like.model_copy(update={"part": part}), like, tmp_path, tmp_path / folder / "second.toml")
    again = read_case(file)
    assert again.part == part and again.friction == like.friction
    assert again.plate.read_motion == like.plate.read_motion
    assert folder or file.read_text() == like.source.replace('["0.06 mm", "20 um"]', '["0.01 mm", "0 um"]')
    assert "# measured" in file.read_text() and "# the cube" in file.read_text() and "law.csv" in file.read_text()


def test_a_case_made_in_python_is_written_as_ever(tmp_path):
    like = read(tmp_path, TEXT).model_copy(update={"source": None})
    assert "#" not in edited(moved(like), like, tmp_path)
