"""Two runs side by side: the fields in which their cases differ, how far their paths are apart, picture and command."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from active_surface.cli.program import main
from coupling import Case, compare, read_run
from coupling.case import differences

DISC = {"shape": "disc", "radius": "1 mm", "youngs_modulus": "169 GPa", "poisson_ratio": 0.3, "thickness": "9 um"}
PAIR = [{"position": [x, "0 um"], "stroke": "2 um", "frequency": "1 kHz"} for x in ("-90 um", "90 um")]
PARTS = Path(__file__).parents[2] / "examples" / "parts.toml"
DRIFT = 2e-3  # m/s


def case(**tables):
    usual = {"part": {"mass": "2 ug", "position": ["0 um", "0 um"]}, "friction": {"model": "constant", "limit": "5 nN"}}
    return Case(**usual | {"plate": DISC, "actuators": PAIR, "run": {"duration": "1 ms"}} | tables)


def test_fields_that_differ_have_their_places_values_and_units():
    one = case()
    other = one.vary({"actuators.*.stroke": "3 um", "actuators.1.phase": "20 deg", "part.position.1": "4 um"})
    assert list(differences(one, one)) == []
    assert list(differences(one, other)) == [
        ("actuators.*.stroke", "2 um", "3 um"),
        ("actuators.1.phase", "0 deg", "20 deg"),
        ("part.position", "[0 um, 0 um]", "[0 um, 4 um]"),
    ]


def test_a_file_differs_by_its_contents(tmp_path):
    cases = []
    for name, shift in (("a", 0.0), ("b", 0.0), ("c", 1.0)):
        (tmp_path / name).mkdir()
        rows = "".join(f"{k},{k + shift}\n" for k in range(9))
        (tmp_path / name / "motion.csv").write_text(f"time [ms],x [um]\n{rows}")
        platform = {"shape": "platform", "motion": str(tmp_path / name / "motion.csv")}
        cases.append(case(plate=platform, actuators=[]))
    assert list(differences(*cases[:2])) == []
    assert [*differences(*cases[1:])] == [("plate.motion", "motion.csv", "motion.csv (other contents)")]


def drifting(result, ends):
    """The run with a path that drifts away along y from its first moment on, up to a share of its rows."""
    path = result.trajectory
    moved = {
        "position": path.position + np.outer(path.time, (0, DRIFT)),
        "velocity": path.velocity + (0, DRIFT),
    }
    columns = {name: getattr(path, name) for name in ("time", "state")} | moved
    count = int(ends * len(path.time))
    trajectory = replace(path, **{name: column[:count] for name, column in columns.items()})
    summary = replace(result.summary, end_time=float(trajectory.time[-1]))
    return replace(result, trajectory=trajectory, summary=summary)


def test_distances_are_those_of_the_paths_up_to_the_end_of_the_shorter(ran):
    result = ran("linear")
    whole, cut = (compare(result, drifting(result, share)) for share in (1.0, 0.5))
    for found in (whole, cut):
        np.testing.assert_allclose(found.distance, DRIFT * found.time, rtol=1e-9, atol=1e-18)
        assert found.farthest == (found.distance[-1], found.time[-1])
    assert whole.time[-1] == result.trajectory.time[-1] > cut.time[-1]
    assert whole.sentence.endswith("where both end.")
    assert cut.sentence.endswith("where the first of them ends.")


def test_a_run_is_the_one_that_is_read_back_and_is_drawn_beside_it(ran):
    result = ran("linear")
    saved = read_run(result.files[0])
    found = compare(result, saved)
    assert (found.differences, found.farthest[0]) == ((), 0.0)
    figure = found.plot()
    ways = [axes for axes in figure.axes if axes.get_ylabel().startswith("way along x")]
    curves = [line.get_ydata() for line in ways[0].lines if len(line.get_ydata()) > 1]
    assert len(curves) == 2
    assert np.ptp(curves[0]) == pytest.approx(np.ptp(curves[1]), rel=1e-3)
    assert {f"{saved.name}, A", f"{saved.name}, B"} <= {text.get_text() for text in figure.legends[0].texts}


def test_the_command_writes_figures_and_a_picture(ran, tmp_path):
    name = str(ran("linear").files[0])
    done = CliRunner().invoke(main, ["compare", name, name, "--json", "--output", str(tmp_path / "new")])
    assert done.exit_code == 0, done.output
    figures = json.loads(done.output)
    assert (figures["differences"], figures["largest_distance"]) == ({}, 0.0)
    assert [str(file) for file in (tmp_path / "new").iterdir()] == figures["files"]
    assert "none differs" in CliRunner().invoke(main, ["compare", name, name, "-o", str(tmp_path)]).output


@pytest.mark.parametrize("place", [0, 1])
def test_what_is_no_run_of_one_part_is_refused_by_its_name(ran, tmp_path, place):
    good = str(ran("linear").files[0])
    gone = tmp_path / "gone", f"{'AB'[place]} must be a case file or a result"
    for bad, said in (gone, (PARTS, "parts must be one part here")):
        words = [good, good]
        words[place] = str(bad)
        done = CliRunner().invoke(main, ["compare", *words, "--output", str(tmp_path / "out")])
        assert (done.exit_code, said in done.stderr) == (2, True), done.stderr
    assert not (tmp_path / "out").exists()
