"""Every example with a plate runs; its files are read back by VTK's own reader, and the part stands on the surface."""

from pathlib import Path

import numpy as np
import pytest
import pyvista

from coupling import read_case, read_parts, report, run_case
from coupling.display import onto_plate
from particle import State

FILES = sorted((Path(__file__).parents[2] / "examples").glob("*.toml"))
LARGE = "array_100x100"
QUICK = "rectangle_2x2"
SOME = 50  # steps of each file that are looked at
EXAMPLES = [
    pytest.param(file, id=file.stem, marks=[pytest.mark.slow] if file.stem != QUICK else [])
    for file in FILES
    if 'shape = "platform"' not in file.read_text() and file.stem != LARGE
]
pytestmark = pytest.mark.compiled


@pytest.fixture(scope="module", params=EXAMPLES)
def result(request, tmp_path_factory):
    return run_case(read_parts(request.param)[0], output=tmp_path_factory.mktemp("results"))


def test_writes_one_file_of_each_kind_and_nothing_partial(result):
    folder = result.files[0].parent
    assert sorted(file.name for file in folder.iterdir()) == sorted(
        f"{result.case.name}.{end}" for end in ("plate.vtkhdf", "part.vtkhdf", "png")
    )


def test_part_stands_on_the_surface(result):
    plate, part = (pyvista.get_reader(str(file)).reader for file in result.files[:2])
    plate.UpdateInformation()
    part.UpdateInformation()
    steps = part.GetNumberOfSteps()
    assert steps == plate.GetNumberOfSteps() >= 100
    times = []
    for step in sorted({*range(0, steps, max(1, steps // SOME)), steps - 1}):
        part.SetStep(step)
        part.Update()
        time = part.GetTimeValue()
        times.append(time)
        drawn = pyvista.wrap(part.GetOutputDataObject(0))
        x, y, z = drawn.points[0]
        place = onto_plate(result.shapes.outline, np.array([[x, y]]))  # a part that left is drawn at the rim
        height = result.surface.evaluate(place, time).w[0]
        if (face := result.case.part.face) is not None:  # its middle is at the mean height under it
            c, s = (side := drawn.points[2, :2] - drawn.points[1, :2]) / np.hypot(*side)  # along its own x
            under, weights = face.averaging(5)
            places = place + under @ np.array([[c, s], [-s, c]])
            height = weights @ result.surface.evaluate(places, time).w
        assert z == pytest.approx(height, abs=1e-11) or (drawn["state"][0] == State.FLIGHT and z > height)
    assert times[0] == 0.0
    assert times[-1] == pytest.approx(result.trajectory.time[-1])


def test_the_drawn_plate_is_the_plate(result):
    """Its area is that of the solved mesh, and no cell of it is turned over."""
    grid = pyvista.read(str(result.files[0]))
    drawn = areas(grid.points[:, :2].astype(float), grid.cells_dict[5])
    stretch = result.scene.stretch
    solved = result.shapes.model.mesh if stretch is None else stretch.model.reduction.discrete.mesh
    solved = solved.refined().refined()  # chords of large cells cut off more of the rim
    assert (drawn > 0).all()
    assert drawn.sum() == pytest.approx(areas(solved.points, solved.triangles).sum(), rel=1e-3)


def areas(points, triangles):
    (a, b), (c, d) = (points[triangles[:, k]].T - points[triangles[:, 0]].T for k in (1, 2))
    return (a * d - b * c) / 2


def test_plate_is_lifted_by_the_drives(result):
    reader = pyvista.get_reader(str(result.files[0])).reader
    reader.UpdateInformation()
    actuators = np.array([actuator.position for actuator in result.case.actuators])
    some = np.arange(0, len(actuators), max(1, len(actuators) // 16))  # each has cells that must be built
    scale = result.case.actuators[0].stroke or result.summary.deflection_over_thickness * result.case.plate.thickness
    steps = reader.GetNumberOfSteps()
    for step in range(0, steps, max(1, steps // SOME)):
        reader.SetStep(step)
        reader.Update()
        grid = pyvista.wrap(reader.GetOutputDataObject(0))
        found = grid.points[: len(actuators), :2]
        assert np.abs(found - actuators).max() < 1e-12
        heights = result.surface.evaluate(actuators[some], reader.GetTimeValue()).w
        assert grid["deflection"][some] == pytest.approx(heights, abs=1e-6 * scale)


def test_summary_warns_where_the_model_ends(result):
    holds = not result.case.source.startswith("# Outside ")
    stretches = result.summary.theory == "von-karman"
    assert (result.summary.deflection_over_thickness < 0.2) == (holds and not stretches)
    assert any("times its thickness" in warning for warning in report.warnings(result.summary)) != holds
    assert (result.summary.largest_slope < 0.2) == holds
    assert bool(report.warnings(result.summary)) != holds


@pytest.mark.slow
def test_ten_thousand_actuators_run_and_their_files_stay_small(tmp_path):
    result = run_case(read_case(FILES[0].with_name(f"{LARGE}.toml")), output=tmp_path)
    assert len(result.case.actuators) == 10_000
    summary = result.summary
    assert summary.plate_error < 1e-6 and summary.hold_residual < 1e-6
    assert 0.006 <= summary.deflection_over_thickness < 0.007 and 0 < summary.part_sag < 1e-12
    assert 1e6 < summary.first_frequency < 1e8 and summary.drives_over_first == (summary.drive_over_first,) * 2
    assert sum(file.stat().st_size for file in result.files) < 50e6
    test_plate_is_lifted_by_the_drives(result)
