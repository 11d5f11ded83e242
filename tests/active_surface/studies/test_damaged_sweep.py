"""Files of sweeps that are damaged are refused with one sentence, whatever is wrong with them."""

import re

import h5py
import numpy as np
import pytest
from click.testing import CliRunner
from sweeps import PLATFORM

from active_surface.cli import main
from active_surface.studies import read_study, read_sweep, run_study
from active_surface.studies.sweep_file import key_of

STUDY = """[study]
case = "base.toml"

[[axes]]
field = "plate.motion.x.frequency"
values = ["200 Hz", "300 Hz"]
"""


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    folder = tmp_path_factory.mktemp("sweep")
    (folder / "base.toml").write_text(PLATFORM)
    (folder / "study.toml").write_text(STUDY)
    run_study(read_study(folder / "study.toml"), folder).dataset.close()
    return (folder / "study.nc").read_bytes()


def put(name, value):
    def change(file):
        del file[name]
        file[name] = value

    return change


def attribute(name, value):
    def change(file):
        file.attrs[name] = value

    return change


def no_points(file):
    (axis,) = (name for name in file if "field" in file[name].attrs)
    field = file[axis].attrs["field"]
    for name in list(file):
        kind = file[name].dtype
        del file[name]
        file.create_dataset(name, (0,), kind)
    file[axis].attrs["field"] = field
    file[axis].make_scale(axis)
    for name in file:
        if name != axis:
            file[name].dims[0].attach_scale(file[axis])


def huge(file):
    del file["distance"]
    file.create_dataset("distance", (10**12,), "f8", chunks=(1000,))


DAMAGES = [
    (attribute("key", 5), "a text in it is none"),
    (attribute("axes", [1, 2]), "a text in it is none"),
    (attribute("axes", "nothing"), "it cannot be read to its end"),
    (attribute("traits", "[]"), "its traits are no dict"),
    (attribute("study", "= ["), "it cannot be read to its end"),
    (attribute("rim", [1.0, 2.0, 3.0]), "its rim has no places"),
    (lambda file: file.__delitem__("distance"), "it cannot be read to its end"),
    (put("distance", np.zeros(7)), "(its distance does not fit its outcomes|it cannot be read to its end)"),
    (huge, "its distance says that it has 8000000000000 bytes, of which 0 are there"),
    (put("distance", h5py.SoftLink("/nowhere")), "its distance is a link"),
    (no_points, "it has no points"),
]


@pytest.mark.compiled
@pytest.mark.parametrize(("change", "wrong"), DAMAGES, ids=[wrong for _, wrong in DAMAGES])
def test_what_is_damaged_is_named(made, tmp_path, change, wrong):
    path = tmp_path / "study.nc"
    path.write_bytes(made)
    assert key_of(path)
    with h5py.File(path, "r+") as file:
        change(file)
    with pytest.raises(ValueError, match=f"is a sweep that is damaged: {wrong}; remove it and sweep again"):
        read_sweep(path)
    done = CliRunner().invoke(main, ["plot", str(path), "-o", str(tmp_path / "out")])
    assert done.exit_code == 2 and re.search(wrong, done.output) and not (tmp_path / "out").exists()


@pytest.mark.compiled
def test_a_file_that_ends_early_is_no_sweep(made, tmp_path):
    path = tmp_path / "study.nc"
    for length in (0, 5, 100, 2000, len(made) // 2, len(made) - 1):
        path.write_bytes(made[:length])
        with pytest.raises(ValueError, match=r"which is something else|is a sweep that is damaged"):
            read_sweep(path)
