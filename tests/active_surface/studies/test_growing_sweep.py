"""Sweeps that grow: finished paths are kept, and the results have the bytes of a sweep made at once."""

import re
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
from click.testing import CliRunner
from sweeps import PLATE, PLATFORM, written

from active_surface.cli.program import main
from active_surface.studies import read_study, run_study
from active_surface.studies.engine import Engine
from active_surface.studies.sweep_file import finished_paths, keys_of
from coupling import batch

MASS = '[[axes]]\nfield = "part.mass"\nvalues = ["1e-9 kg", "2e-9 kg"]\n'
LIMIT = '[[axes]]\nfield = "friction.limit"\nvalues = ["10 nN", "20 nN", "15 nN"]\n'
pytestmark = pytest.mark.usefixtures("without_pictures")

STROKE = '[[axes]]\nfield = "plate.motion.x.stroke"\nvalues = [{}]\n'
DRAWN = 'sampling = "{}"\npoints = {}\nseed = 3\n[[axes]]\nfield = "friction.limit"\nrange = ["10 nN", "30 nN"]\n'
JITTER = 'repeats = {}\njitter = "1 um"\n'
LISTED = 'sampling = "list"\n[[axes]]\nfield = "friction.limit"\nvalues = [{}]\n'
GROWN = {
    "values before and between": (MASS, MASS.replace('["1e-9 kg"', '["5e-10 kg", "1e-9 kg", "1.5e-9 kg"'), 2),
    "values in another order": (MASS, MASS.replace('"1e-9 kg", "2e-9 kg"', '"2e-9 kg", "3e-9 kg", "1e-9 kg"'), 2),
    "an axis that varies the surface": (MASS, STROKE.format('"10 um", "20 um"') + MASS, 2),
    "an axis less": (MASS + LIMIT.replace('"10 nN", ', "").replace(', "15 nN"', ""), MASS, 2),
    "points of a Sobol sequence": (DRAWN.format("sobol", 4), DRAWN.format("sobol", 16), 4),
    "repeats and values": (JITTER.format(2) + MASS, JITTER.format(3) + MASS.replace('["', '["9e-9 kg", "'), 4),
    "repeats of random points": (
        *(JITTER.format(2) + DRAWN.format("random", 2), JITTER.format(3) + DRAWN.format("random", 4)),
        4,
    ),
    "a list that says a point twice": (
        JITTER.format(2) + LISTED.format('"1 nN", "1 nN"'),
        JITTER.format(2) + LISTED.format('"1 nN", "9 nN", "1 nN", "1 nN"'),
        4,
    ),
}  # fmt: skip


def grown(tmp_path, before, after, case=PLATFORM):
    """A sweep that grew and one made at once, each with its file's bytes."""
    run_study(read_study(written(tmp_path, before, case)), tmp_path / "grown").dataset.close()
    study = read_study(written(tmp_path, after, case))
    sweeps = [run_study(study, tmp_path / folder) for folder in ("grown", "fresh")]
    for sweep in sweeps:
        sweep.dataset.close()
    return sweeps, [(tmp_path / folder / "study.nc").read_bytes() for folder in ("grown", "fresh")]


@pytest.mark.parametrize(
    "what", [pytest.param(what, marks=[pytest.mark.slow] if k % 2 else []) for k, what in enumerate(GROWN)]
)
def test_a_grown_sweep_has_the_bytes_of_a_fresh_one(what, tmp_path, monkeypatch):
    before, after, kept = GROWN[what]
    computed, records = [], Engine.records
    monkeypatch.setattr(
        Engine, "records", lambda self, numbers: computed.append(len(numbers)) or records(self, numbers)
    )
    (sweep, fresh), (content, expected) = grown(tmp_path, before, after)
    assert content == expected
    assert sweep.kept == kept and fresh.kept == 0
    old = len(read_study(written(tmp_path, before, PLATFORM)).points)
    assert sum(computed) == old + (len(sweep.study.points) - kept) + len(sweep.study.points)


def test_paths_that_would_be_lost_are_only_with_overwrite(tmp_path):
    three = MASS.replace('"]', '", "3e-9 kg"]')
    command = ["sweep", str(written(tmp_path, three, PLATFORM)), "-o", str(tmp_path / "out")]
    assert CliRunner().invoke(main, command).exit_code == 0
    kept = (tmp_path / "out" / "study.nc").read_bytes()
    written(tmp_path, MASS.replace('"]', '", "4e-9 kg"]'), PLATFORM)
    done = CliRunner().invoke(main, command)
    expected = "of other points, 1 of which are not in this study: --overwrite drops these and keeps the other 2 paths"
    assert done.exit_code == 2 and expected in done.output
    assert (tmp_path / "out" / "study.nc").read_bytes() == kept
    done = CliRunner().invoke(main, [*command, "--overwrite"])
    assert done.exit_code == 0 and "kept        2 of these paths from an earlier sweep; 1 is new\n" in done.output
    again = CliRunner().invoke(main, command)
    assert "kept        3 of these paths from an earlier sweep; none are new\n" in again.output


@pytest.mark.parametrize("change", ["another jitter", "another seed", "another case"])
def test_what_paths_follow_from_is_compared(change, tmp_path):
    before = JITTER.format(2) + MASS
    run_study(read_study(written(tmp_path, before, PLATFORM)), tmp_path / "out").dataset.close()
    after, case = {
        "another jitter": (before.replace("1 um", "2 um"), PLATFORM),
        "another seed": ("seed = 9\n" + before, PLATFORM),
        "another case": (before, PLATFORM.replace("20 nN", "21 nN")),
    }[change]
    study, file = read_study(written(tmp_path, after, case)), tmp_path / "out" / "study.nc"
    assert list(finished_paths(study, file)) == []
    with pytest.raises(ValueError, match="whose study.nc is of other .*: --overwrite replaces it"):
        run_study(study, tmp_path / "out")


def test_refused_points_and_texts_are_kept_too(tmp_path, monkeypatch):
    follow = batch.simulate_many

    def failing(surface, parts, *rest):
        if any(part.mass == 2e-9 for part in parts):
            raise ValueError("it went wrong")
        return follow(surface, parts, *rest)

    monkeypatch.setattr(batch, "simulate_many", failing)
    cycles = '[[axes]]\nfield = "plate.motion.x.cycle"\nvalues = ["up-down", "sine"]\n'
    (sweep, _), (content, expected) = grown(tmp_path, MASS, cycles + MASS)
    assert content == expected and sweep.kept == 2
    assert sweep.dataset["mistakes"].values.tolist() == [[0, 1], [0, 1]]


@pytest.mark.compiled
@pytest.mark.slow
def test_a_sweep_over_a_plate_grows_by_an_axis(tmp_path):
    after = f'{MASS}[[axes]]\nfield = "plate.thickness"\nvalues = ["5 um", "6 um"]\n'
    (sweep, _), (content, expected) = grown(tmp_path, MASS, after, PLATE.replace('"5 ms"', '"1 ms"'))
    assert content == expected and sweep.kept == 2


def test_paths_over_a_plate_solved_for_all_drives_together_are_not_kept(tmp_path):
    stretching = PLATE.replace('"disc"', '"disc"\ntheory = "von-karman"')
    stroke = '[[axes]]\nfield = "actuators.*.stroke"\nvalues = ["1 um", "2 um"]\n'
    more = stroke.replace("2 um", "3 um")
    keys = {read_study(written(tmp_path, text, stretching)).heights for text in (stroke, more)}
    assert len(keys) == 2 and "" not in keys
    starts = '[[axes]]\nfield = "part.position.0"\nvalues = ["1 um", "{}"]\n'
    keys = {read_study(written(tmp_path, starts.format(x), stretching)).heights for x in ("2 um", "3 um")}
    assert len(keys) == 1  # the drives are the same
    assert read_study(written(tmp_path, stroke, PLATE)).heights == ""


@pytest.mark.parametrize("sampling", ["random", "sobol", "grid", "list"])
def test_displacements_follow_the_point_wherever_it_is(tmp_path, sampling):
    axes = '[[axes]]\nfield = "friction.limit"\nvalues = ["1 nN", "2 nN", "3 nN"]\n'
    drawn = "points = 40\n" if sampling in ("random", "sobol") else ""
    points = read_study(written(tmp_path, f'sampling = "{sampling}"\n{drawn}{JITTER.format(4)}{axes}', PLATFORM)).points
    away = points.displacements(range(len(points)))
    assert len(np.unique(away[:, 0])) == len(points)  # no two paths share one
    few = read_study(
        written(tmp_path, f'sampling = "{sampling}"\n{drawn.replace("40", "7")}{JITTER.format(2)}{axes}', PLATFORM)
    ).points
    count = len(few) // 2
    same = away.reshape(-1, 4, 2)[:count, :2]
    assert np.array_equal(few.displacements(range(len(few))).reshape(-1, 2, 2), same)


def finished(table, study):
    """How many paths of a study are in the file of a table that is in use: a key is there once for each table."""
    content = table.read_bytes() if table.exists() else b""
    return sum(content.count(key) > 1 for key in keys_of(study))


def stopped(command, table, study, paths, number):
    """The exit code of a sweep that got a signal when so many paths were finished; its errors."""
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as process:
        while finished(table, study) < paths:
            assert process.poll() is None
            time.sleep(0.002)
        process.send_signal(number)
        return process.wait(), process.stderr.read()


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="needs signals")
def test_a_growing_sweep_that_is_killed_and_interrupted_loses_neither_the_old_nor_the_new(tmp_path):
    random = 'sampling = "random"\npoints = {}\n' + re.sub(r"values.*", 'range = ["1e-9 kg", "9e-9 kg"]', MASS)
    case, folder = PLATFORM.replace('"2 ms"', '"2 s"'), tmp_path / "out"
    run_study(read_study(written(tmp_path, random.format(4), case)), folder).dataset.close()
    before, table = (folder / "study.nc").read_bytes(), folder / "study.sweep"
    study = read_study(written(tmp_path, random.format(16), case))
    command = [sys.executable, "-m", "active_surface", "sweep", str(tmp_path / "study.toml"), "-o", str(folder), "-q"]
    assert stopped(command, table, study, 5, signal.SIGKILL)[0] == -signal.SIGKILL
    killed = finished(table, study)
    code, errors = stopped(command, table, study, killed + 1, signal.SIGINT)
    assert (code, errors) == (130, "interrupted; the same command goes on where this one stopped\n")
    assert (folder / "study.nc").read_bytes() == before
    done, counts = finished(table, study), []
    assert done > killed >= 5
    sweep = run_study(study, folder, tell=lambda paths, of: counts.append(paths))
    assert counts[0] == done and sweep.kept == 4
    run_study(study, tmp_path / "fresh")
    assert (folder / "study.nc").read_bytes() == (tmp_path / "fresh" / "study.nc").read_bytes()
