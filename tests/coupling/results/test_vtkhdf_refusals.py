"""Steps and meshes that a result file refuses: they leave no trace in it."""

from pathlib import Path

import numpy as np
import pytest
from vtkhdf_files import POINTS, TRIANGLES, bump, gradient, names, position, step_in_vtk, times_in_vtk

from coupling.results import vtkhdf


@pytest.mark.parametrize("times", [[0.1, 0.3, 0.2], [0.1, 0.1], [0.1, float("nan")], [0.05, 0.2]])
def test_a_refused_block_leaves_no_trace(tmp_path: Path, times: list[float]) -> None:
    with vtkhdf.part_file(tmp_path, "run") as part:
        part.append(0.05, position(0))
        with pytest.raises(ValueError, match=r"time \S+ s is refused"):
            part.append(times, np.zeros((len(times), 3)))
        part.append(0.4, position(1))
    assert times_in_vtk(tmp_path / "run.part.vtkhdf") == [0.05, 0.4]


@pytest.mark.parametrize(
    ("time", "changes", "message"),
    [
        (0.2, {"extra": bump(0)}, r"\[\] missing, \['extra'\] new"),
        (0.2, {"gradient": None}, r"\['gradient'\] missing, \[\] new"),
        (0.2, {"gradient": bump(0)}, r"'gradient' has shape \(49,\), unlike in the first step"),
        (0.2, {"deflection": bump(0)[:-1]}, r"'deflection' has shape \(48,\); it must have \(49,\) or \(49, 3\)"),
        (0.2, {"state": np.full(49, 0.5)}, "'state' is of type float64; in the first step it was int64"),
        (0.2, {"deflection": np.full(49, "high")}, "'deflection' is not numeric"),
        (0.1, {}, "time 0.1 s"),
        (0.05, {}, "time 0.05 s"),
        (float("nan"), {}, "time nan s"),
    ],
)
def test_a_refused_step_leaves_no_trace(
    tmp_path: Path, time: float, changes: dict[str, np.ndarray | None], message: str
) -> None:
    fields = {"deflection": bump(0), "gradient": gradient(0), "state": np.arange(49)}
    changed = {name: value for name, value in (fields | changes).items() if value is not None}
    with vtkhdf.plate_file(tmp_path, "run", POINTS, TRIANGLES) as plate:
        plate.append(0.1, **fields)
        with pytest.raises(ValueError, match=message):
            plate.append(time, **changed)
        plate.append(0.3, **(fields | {"deflection": bump(7)}))
    path = tmp_path / "run.plate.vtkhdf"
    assert times_in_vtk(path) == [0.1, 0.3]
    np.testing.assert_array_equal(step_in_vtk(path, 0)["deflection"], bump(0))
    np.testing.assert_array_equal(step_in_vtk(path, 1)["deflection"], bump(7))


@pytest.mark.parametrize(
    ("place", "velocity", "message"),
    [
        ((0.0, 0.0), (0.0, 0.0, 0.0), r"position has shape \(2,\)"),
        ((0.0, 0.0, 0.0), (0.0, 0.0), r"'velocity' has shape \(2,\); it must have \(\) or \(3,\)"),
    ],
)
def test_a_part_step_of_wrong_shape_is_refused(
    tmp_path: Path, place: tuple[float, ...], velocity: tuple[float, ...], message: str
) -> None:
    with vtkhdf.part_file(tmp_path, "run") as part:
        with pytest.raises(ValueError, match=message):
            part.append(0.0, place, velocity=velocity)
        part.append(0.0, position(1), velocity=(1.0, 2.0, 3.0))
    np.testing.assert_array_equal(step_in_vtk(tmp_path / "run.part.vtkhdf", 0).points, [position(1)])


@pytest.mark.parametrize(
    ("points", "triangles", "message"),
    [
        (POINTS[:, :1], TRIANGLES, "points of shape"),
        (np.full((3, 2), np.nan), [[0, 1, 2]], "must be finite"),
        (POINTS, TRIANGLES[:, :2], "triangles of shape"),
        (POINTS, TRIANGLES.astype(float), "must be integers"),
        (POINTS, TRIANGLES + 1, "name points 1 to 49; there are 49"),
        (POINTS, TRIANGLES - 1, "name points -1 to 47; there are 49"),
    ],
)
def test_a_mesh_without_meaning_is_refused_before_a_file_is_touched(
    tmp_path: Path, points: np.ndarray, triangles: np.ndarray, message: str
) -> None:
    with pytest.raises(ValueError, match=message):
        vtkhdf.plate_file(tmp_path, "run", points, triangles)
    assert names(tmp_path) == []


def test_a_result_without_steps_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="has no step"), vtkhdf.part_file(tmp_path, "run"):
        pass
    assert names(tmp_path) == ["run.partial.part.vtkhdf"]
