"""A surface is written and read again with the same bits."""

import h5py
import numpy as np
import pytest
from sweeps import toml

from coupling import read_case, read_surface, run_case, surface_motion, write_surface
from fem_plate.analytic import DiscShapes
from particle import ConstantFriction, Drive, Micropart, platform_surface, simulate, simulate_many

RADIUS, MASS = 300e-6, 2e-9
LAW = ConstantFriction(4e-9)
START = (60e-6, 20e-6)


def thirteen():
    x = np.linspace(-0.5, 0.5, 4)
    points = np.concatenate([np.stack(np.meshgrid(x[:3], x), -1).reshape(-1, 2), [[0.62, 0.1]]]) * RADIUS
    return surface_motion(DiscShapes(points, RADIUS), [Drive(10e-6, 900.0 + 10 * k) for k in range(13)])


def path_over(surface, start=START):
    return simulate(surface, Micropart(MASS, start), LAW, 3e-3, tolerance=1e-5)


def test_a_path_over_a_saved_surface_has_the_same_bits(tmp_path):
    surface = thirteen()
    path = path_over(surface)
    again = read_surface(write_surface(surface, tmp_path / "some.h5"))
    assert (again.error, again.size, again.overhang) == (surface.error, surface.size, surface.overhang)
    other = path_over(again)
    assert np.array_equal(other.time, path.time) and np.array_equal(other.position, path.position)
    drives = [Drive(8e-6, 1000.0)] * 13
    assert np.array_equal(
        path_over(again.driven_by(drives)).position[-1], path_over(surface.driven_by(drives)).position[-1]
    )
    assert not list(tmp_path.glob("*.partial"))


def test_a_place_without_a_cell_is_told(tmp_path):
    surface = thirteen()
    path_over(surface)
    again = read_surface(write_surface(surface, tmp_path / "some.h5"))
    with pytest.raises(ValueError, match=r"no cell at \(-200, -150\) um"):
        path_over(again, (-200e-6, -150e-6))
    with pytest.raises(ValueError, match="no cell at"):
        simulate_many(again, [Micropart(MASS, (-200e-6, -150e-6))], LAW, 1e-3)
    with pytest.raises(ValueError, match="no cell at"):
        again.evaluate([[-200e-6, -150e-6]], 0.0)


def test_a_platform_is_saved_too(tmp_path):
    platform = platform_surface(x=Drive(1e-3, 30.0), size=1e-3)
    again = read_surface(write_surface(platform, tmp_path / "platform.h5"))
    assert again.moving_base
    for a, b in zip(again.evaluate([[0.0, 0.0]], 0.01), platform.evaluate([[0.0, 0.0]], 0.01), strict=True):
        assert np.array_equal(a, b)


def test_what_is_something_else_is_neither_read_nor_written_over(tmp_path):
    text, other = tmp_path / "notes.txt", tmp_path / "other.h5"
    text.write_text("mine")
    h5py.File(other, "w").close()
    for path in (text, other):
        with pytest.raises(ValueError, match="must be free or a surface"):
            write_surface(thirteen(), path)
        with pytest.raises(ValueError, match="must be a file that write_surface wrote"):
            read_surface(path)
    assert text.read_text() == "mine"
    with pytest.raises(FileNotFoundError):
        read_surface(tmp_path / "none.h5")
    surface = thirteen()
    write_surface(surface, tmp_path / "twice.h5")
    assert write_surface(surface, tmp_path / "twice.h5").exists()


CASE = toml(
    plate={
        "shape": "disc",
        "radius": "300 um",
        "youngs_modulus": "169 GPa",
        "poisson_ratio": 0.22,
        "thickness": "5 um",
        "cell_size": "100 um",
    },
    actuators=[{"position": ["100 um", "0 um"], "stroke": "1 um", "frequency": "300 Hz"}],
    part={"mass": "2e-9 kg", "position": ["-100 um", "20 um"]},
    friction={"model": "constant", "limit": "4 nN"},
    run={"duration": "1 ms", "frames": 3},
)


@pytest.mark.slow
def test_a_run_saves_its_surface_on_request(tmp_path):
    (tmp_path / "case.toml").write_text(CASE)
    result = run_case(read_case(tmp_path / "case.toml"), tmp_path / "out", save_surface=True)
    assert result.files[-1] == tmp_path / "out" / "case.surface.h5"
    points = [[50e-6, 10e-6], [-100e-6, 20e-6]]
    saved, ours = read_surface(result.files[-1]).evaluate(points, 4e-4), result.surface.evaluate(points, 4e-4)
    assert all(np.array_equal(a, b) for a, b in zip(saved, ours, strict=True))


def test_a_file_in_the_way_of_a_surface_is_told_before_the_run(tmp_path):
    (tmp_path / "case.toml").write_text(CASE)
    foreign = tmp_path / "out" / "case.surface.h5"
    foreign.parent.mkdir()
    foreign.write_text("mine")
    with pytest.raises(ValueError, match=r"must be free or a surface; got \S+case.surface.h5, which is neither"):
        run_case(read_case(tmp_path / "case.toml"), tmp_path / "out", save_surface=True)
    assert list(foreign.parent.iterdir()) == [foreign] and foreign.read_text() == "mine"
