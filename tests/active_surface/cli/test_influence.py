"""The commands `influence` and `fit`: from a case to FITS files, and back to its springs and tension."""

import json

import numpy as np
import pytest
from astropy.io import fits
from click.testing import CliRunner
from sweeps import toml

from active_surface.cli.program import main

CASE = toml(
    plate={
        "shape": "disc",
        "radius": "300 um",
        "youngs_modulus": "169 GPa",
        "poisson_ratio": 0.3,
        "thickness": "5 um",
        "tension": "{tension} N/m",
        "cell_size": "75 um",
    },
    lattice={
        "rows": 3,
        "columns": 3,
        "pitch": "100 um",
        "stroke": "1 um",
        "frequency": "300 Hz",
        "stiffness": "{stiffness} N/m",
    },
    part={"mass": "2e-9 kg", "position": ["0 um", "0 um"]},
    friction={"model": "constant", "limit": "1 uN"},
    run={"duration": "1 ms"},
)


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mirror.toml").write_text(CASE.format(stiffness=250, tension=300))
    (tmp_path / "guess.toml").write_text(CASE.format(stiffness=200, tension=0))
    return tmp_path


def command(*words):
    done = CliRunner().invoke(main, [*words], prog_name="active-surface")
    assert "Traceback" not in done.output and (done.exception is None or isinstance(done.exception, SystemExit))
    return done


def test_a_case_becomes_fits_and_the_fit_finds_its_springs(here):
    assert command("influence", "mirror.toml", "--layout", "specula", "--pixels", "41").exit_code == 0
    done = command("fit", "results/mirror.specula.fits", "guess.toml")
    assert done.exit_code == 0 and "warning" not in done.output
    for words in ("functions   9 of layout specula", "stiffness   250 N/m +-", "tension     300 N/m +-", "residual"):
        assert words in done.stdout
    done = command("fit", "results/mirror.specula.fits", "guess.toml", "--tension", "300 N/m", "--json")
    figures = json.loads(done.stdout)
    assert figures["stiffness"] == pytest.approx(250, rel=1e-5) and figures["tension_error"] is None


@pytest.mark.parametrize(
    ("layout", "name"), [("proper", "proper.fits"), ("compass", "compass.fits"), ("npz", "influence.npz")]
)
def test_every_layout_has_a_file(here, layout, name):
    done = command("influence", "mirror.toml", "-l", layout, "--pixels", "15", "-o", "out")
    assert done.exit_code == 0 and f"out/mirror.{name}" in done.stdout
    assert [path.name for path in (here / "out").iterdir()] == [f"mirror.{name}"]


def test_dead_actuators_stand_still_or_follow(here):
    """One that stands still holds the plate down; one that follows lets its neighbours raise it."""
    peaks = {}
    for option in ("--dead", "--passive"):
        assert command("influence", "mirror.toml", "-l", "specula", "--pixels", "21", option, "4").exit_code == 0
        table = fits.getdata("results/mirror.specula.fits", "ACTUATORS")
        functions = fits.getdata("results/mirror.specula.fits", "INFLUENCE_FUNCTION")
        assert np.flatnonzero(table["DEAD"]).tolist() == [4] and not functions[:, 4].any()
        assert table["STIFFNESS"][4] == (250 if option == "--dead" else 0)
        peaks[option] = np.delete(table["PEAK"], 4)
    assert (peaks["--passive"] > 1.01 * peaks["--dead"]).all()


MISUSES = [
    (["influence", "mirror.toml", "-l", "yao"], "'yao' is not one of 'proper', 'compass', 'specula', 'npz'"),
    (
        ["influence", "mirror.toml", "-l", "compass", "--dead", "x"],
        '--dead must be numbers of actuators, such as "3,7"',
    ),
    (
        ["influence", "mirror.toml", "-l", "npz", "--dead", "1,9", "--actuator", "9"],
        "active-surface influence: 3 mistakes\n  --dead must be actuators from 0 to 8; got 9\n"
        "  --dead must not be given with --layout npz\n"
        "  --actuator must not be given with --layout npz, which has all\n",
    ),
    (
        ["influence", "mirror.toml", "-l", "proper", "--dead", "2", "--passive", "2", "--actuator", "2"],
        "  --passive must not be given for actuators that stand still; got 2 in both\n"
        "  --actuator must be one from 0 to 8 that is not dead; got 2\n",
    ),
    (["fit", "mirror.toml", "mirror.toml"], "  INFLUENCE must be a FITS file; got mirror.toml, which is none"),
    (["fit", "none.fits", "mirror.toml"], "active-surface fit: none.fits: no such file or directory"),
    (["fit", "image.fits", "mirror.toml"], "  --pixel must be given, as image.fits has no key P2PDX_M"),
    (["fit", "image.fits", "mirror.toml", "--pixel", "2"], '--pixel must be a length such as "2 um"; got "2"'),
    (["fit", "image.fits", "mirror.toml", "--stiffness", "0 N/m"], "--stiffness must be greater than 0; got 0 N/m"),
    (
        ["fit", "image.fits", "mirror.toml", "--stiffness", "1 N/m", "--tension", "0 N/m"],
        "--tension must not be given with --stiffness; nothing is left to fit",
    ),
    (
        ["fit", "image.fits", "mirror.toml", "--pixel", "9 um", "--actuator", "9"],
        "--actuator must be from 0 to 8; got 9",
    ),
]


@pytest.mark.parametrize(("words", "said"), MISUSES, ids=lambda value: " ".join(value) if type(value) is list else "")
def test_misuse_exits_2_with_all_that_is_wrong_and_writes_nothing(here, words, said):
    fits.PrimaryHDU(np.ones((5, 5))).writeto("image.fits")
    before = sorted(here.iterdir())
    done = command(*words)
    assert (done.exit_code, done.stdout) == (2, "") and said in done.stderr
    assert sorted(here.iterdir()) == before


def test_what_is_not_determined_is_warned_of(here):
    """The function of one of nine on rigid actuators does not say how stiff they are."""
    (here / "rigid.toml").write_text(CASE.format(stiffness=1e9, tension=0))
    command("influence", "rigid.toml", "-l", "specula", "--pixels", "15")
    done = command("fit", "results/rigid.specula.fits", "guess.toml", "--tension", "0 N/m")
    assert done.exit_code == 0 and "warning     the actuators cannot be distinguished from rigid ones" in done.output


def test_another_pitch_and_what_is_no_influence_function_are_warned_of(here):
    command("influence", "mirror.toml", "--layout", "proper")
    (here / "wide.toml").write_text(CASE.format(stiffness=250, tension=300).replace("100 um", "120 um"))
    done = command("fit", "results/mirror.proper.fits", "wide.toml", "--tension", "300 N/m")
    words = "the file is of actuators 100 µm apart (C2CDX_M), the nearest of the case are 120 µm apart"
    assert done.exit_code == 0 and words in done.output
    assert "C2CDX_M" not in command("fit", "results/mirror.proper.fits", "mirror.toml", "--tension", "300 N/m").output
    noise = np.random.default_rng(0).normal(size=(31, 31))
    fits.PrimaryHDU(noise).writeto("noise.fits")
    done = command("fit", "noise.fits", "mirror.toml", "--pixel", "9 um", "--tension", "300 N/m")
    assert done.exit_code == 0 and "the functions are not those of this plate: the best fit leaves " in done.output


@pytest.mark.parametrize("layout", ["proper", "compass", "specula"])
def test_a_file_that_is_cut_off_is_said_to_be(here, layout):
    command("influence", "mirror.toml", "--layout", layout)
    whole = (here / f"results/mirror.{layout}.fits").read_bytes()
    for share in (0.4, 0.7, 0.95):
        (here / "cut.fits").write_bytes(whole[: int(share * len(whole))])
        done = command("fit", "cut.fits", "mirror.toml")
        assert done.exit_code == 2 and "reshape" not in done.output and "must " in done.output
