"""A saved run is repeated from its files alone, and says whether it came to the same end."""

import json
import shutil
from pathlib import Path

import h5py
import meshio
import numpy as np
import pytest
from click.testing import CliRunner
from sweeps import PLATE, altered, toml

import meshes
from active_surface.cli.program import main
from coupling import environment as versions
from coupling import read_case, read_run, run_case
from coupling.progress import silent
from coupling.results.case_record import case_of, record_of

POINTS = "load [uN], limit [nN]\n-1, 4\n0, 18.7\n2.2, 35\n5, 52\n"


def rerun(path, *options):
    return CliRunner().invoke(main, ["rerun", str(path), *options])


@pytest.fixture
def moved(tmp_path):
    """The result of a case with files, moved away from them."""

    def move(text, **files):
        home = tmp_path / "home"
        home.mkdir()
        for name, content in files.items():
            (home / name.replace("_", ".")).write_bytes(content)
        (home / "some.toml").write_text(text)
        run_case(read_case(home / "some.toml"), home / "out")
        away = shutil.move(home / "out", tmp_path / "away")
        shutil.rmtree(home)
        return Path(away) / "some"

    return move


PLATFORM = toml(
    plate={"shape": "platform", "motion": "motion.csv"},
    part={"mass": "2e-9 kg", "position": ["0 um", "0 um"]},
    friction={"model": "table", "file": "friction.csv"},
    run={"duration": "6 ms", "frames": 5},
)
MOTION = "time [ms], x [um]\n" + "".join(f"{k}, {(-1) ** k * k * 10}\n" for k in range(8))


@pytest.mark.slow
def test_a_moved_result_with_a_measured_motion_and_friction_reruns_to_the_same_bits(moved, tmp_path):
    result = moved(PLATFORM, motion_csv=MOTION.encode(), friction_csv=POINTS.encode())
    done = rerun(result, "--output", str(tmp_path / "again"))
    assert done.exit_code == 0, done.output
    assert "the same, bit for bit" in done.output and "versions    the same" in done.output
    before, after = read_run(result), read_run(tmp_path / "again" / "some")
    assert before.summary == after.summary and before.summary["slips"] > 0
    assert before.rows.position.tobytes() == after.rows.position.tobytes()
    twice = rerun(tmp_path / "again" / "some.part.vtkhdf", "--output", str(tmp_path / "twice"), "--json")
    assert json.loads(twice.stdout)["same_end"] and after.case.source == before.case.source == PLATFORM


@pytest.mark.slow
def test_a_result_keeps_the_files_as_they_were_when_its_run_began(tmp_path):
    (tmp_path / "motion.csv").write_text(MOTION)
    (tmp_path / "friction.csv").write_text(POINTS)
    (tmp_path / "some.toml").write_text(PLATFORM)

    def meanwhile(stage):
        if stage.startswith("Following"):
            (tmp_path / "motion.csv").write_text(MOTION.replace("30", "3"))
        return silent(stage)

    run_case(read_case(tmp_path / "some.toml"), tmp_path / "out", meanwhile)
    assert Path(read_run(tmp_path / "out" / "some").case.plate.motion).read_text() == MOTION
    assert rerun(tmp_path / "out" / "some", "--output", str(tmp_path / "again")).exit_code == 0


MESHED = altered(
    PLATE,
    ('shape = "disc"\nradius = "300 um"', 'mesh = "plate.xdmf"\nsupports = { "7" = "clamped" }'),
    ('cell_size = "80 um"\n', ""),
    ('stroke = "60 um"', 'stroke = "5 um"'),
    ('"-140 um"', '"-100 um"'),
    ('"40 nN"', '"1e-12 N"'),
    ('duration = "5 ms"', 'duration = "0.4 ms"\nframes = 3\ntolerance = 1e-5'),
)


def write_mesh(file):
    """A rectangle in two files: XDMF has its numbers in a file beside it."""
    mesh = meshes.rectangle(400e-6, 300e-6, 100e-6)
    edges = np.concatenate(list(mesh.boundaries.values()))
    cells = [("triangle", mesh.triangles), ("line", edges)]
    numbers = [np.zeros(len(mesh.triangles), int), np.full(len(edges), 7)]
    meshio.Mesh(mesh.points, cells, cell_data={"boundary": numbers}).write(file)
    return mesh


@pytest.mark.parametrize("place", ["./plate.h5", "sub/plate.h5", "../plate.h5"])
def test_a_record_has_what_a_mesh_names_wherever_it_is(tmp_path, place):
    (tmp_path / "home" / "sub").mkdir(parents=True)
    file = tmp_path / "home" / "plate.xdmf"
    mesh = write_mesh(file)
    file.write_text(file.read_text().replace("plate.h5:", f"{place}:"))
    (tmp_path / "home" / "plate.h5").rename(tmp_path / "home" / place)
    (tmp_path / "home" / "some.toml").write_text(MESHED)
    case = read_case(tmp_path / "home" / "some.toml")
    again = case_of(record_of(case), "some")
    (tmp_path / "home" / place).unlink()
    np.testing.assert_array_equal(again.plate.build_mesh().points, mesh.points)
    with pytest.raises(FileNotFoundError, match=r"plate.h5"):
        record_of(case)


@pytest.mark.slow
def test_a_moved_result_with_a_mesh_reruns_to_the_same_bits(moved, tmp_path):
    write_mesh(tmp_path / "plate.xdmf")
    files = {f"plate_{end}": (tmp_path / f"plate.{end}").read_bytes() for end in ("xdmf", "h5")}
    result = moved(MESHED, **files)
    (tmp_path / "plate.h5").unlink()
    done = rerun(result, "--output", str(tmp_path / "again"))
    assert done.exit_code == 0 and "the same, bit for bit" in done.output, done.output
    before, after = read_run(result), read_run(tmp_path / "again" / "some")
    assert np.ptp(before.position[:, 0]) > 0
    np.testing.assert_array_equal(before.rows.position, after.rows.position)
    np.testing.assert_array_equal(before.plate_field("curvature"), after.plate_field("curvature"))


def with_text(change):
    def alter(ours):
        text = ours["case/json"][()].tobytes().decode()
        del ours["case/json"]
        ours["case/json"] = np.frombuffer(change(text).encode(), np.uint8)

    return alter


def with_file(name, content):
    return lambda ours: ours["files"].create_dataset(name, data=np.frombuffer(content, np.uint8))


XDMF = b'<Xdmf Version="3.0"><DataItem Format="%s" Dimensions="3">%s</DataItem></Xdmf>'


LEADS = [
    (with_text(lambda text: text.replace('"motion.csv"', '"/etc/passwd"')), "it lacks the file that plate.motion"),
    (with_text(lambda text: text.replace('"model": "table"', '"model": "table", "file": "/x.csv"')), "names a file"),
    (with_text(lambda text: text.replace('"duration"', '"duratoin"')), "run.duratoin of Case is not known"),
    (with_file("..", b"x"), "it cannot be read to its end"),
    (with_file("a.xdmf", XDMF % (b"HDF", b"/etc/a.h5:/x")), "its file a.xdmf leads elsewhere"),
    (with_file("a.XDMF", XDMF % (b"HDF", b"/etc/a.h5:/x")), "its file a.XDMF leads elsewhere"),
    (with_file("a.xdmf", XDMF % (b"Binary", b"motion.csv")), "its file a.xdmf leads elsewhere"),
]


@pytest.mark.slow
def test_a_result_leads_to_no_other_file(moved, tmp_path):
    result = moved(PLATFORM, motion_csv=MOTION.encode(), friction_csv=POINTS.encode())
    for k, (alter, wrong) in enumerate(LEADS):
        other = Path(shutil.copytree(result.parent, tmp_path / str(k))) / result.name
        with h5py.File(f"{other}.part.vtkhdf", "r+") as file:
            alter(file["active_surface"])
        done = rerun(other, "--output", str(tmp_path / "again"))
        assert done.exit_code == 2 and wrong in done.output and "Traceback" not in done.output, done.output
        assert "Value error" not in done.output and not (tmp_path / "again").exists()


@pytest.mark.slow
def test_another_end_and_other_versions_are_told(moved, tmp_path, monkeypatch):
    result = moved(PLATFORM, motion_csv=MOTION.encode(), friction_csv=POINTS.encode())
    with h5py.File(f"{result}.part.vtkhdf", "r+") as file:
        ours = file["active_surface"].attrs
        summary = json.loads(ours["summary"])
        summary["end_position"][0] += 3e-6
        ours["summary"] = json.dumps(summary)
        ours["versions"] = json.dumps(json.loads(ours["versions"]) | {"numpy": "1.0", "lost": "2.0"})
    done = rerun(result, "--output", str(tmp_path / "again"))
    quiet = rerun(result, "--output", str(tmp_path / "again"), "--quiet")
    assert quiet.exit_code == 1 and not quiet.output
    assert done.exit_code == 1 and ": 3 um from that of the result" in done.output
    now = versions.versions()["numpy"]
    assert f"numpy {now} in place of 1.0; lost none in place of 2.0" in done.output


@pytest.mark.slow
def test_a_partial_result_reruns_and_says_so_but_not_onto_itself(moved, tmp_path):
    result = moved(PLATFORM, motion_csv=MOTION.encode(), friction_csv=POINTS.encode())
    for kind in ("plate", "part"):
        Path(f"{result}.{kind}.vtkhdf").rename(f"{result}.partial.{kind}.vtkhdf")
    done = rerun(result, "--output", str(result.parent))
    assert done.exit_code == 2 and "must be another folder than that of the result" in done.output
    done = rerun(result, "--output", str(tmp_path / "again"))
    assert (
        done.exit_code == 0
        and done.output.startswith("partial     The files lack the last steps")
        and "bit for bit" in done.output
    )
