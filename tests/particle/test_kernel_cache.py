"""No kernel is stale, wherever the cache lies, and several processes do not compile the same one."""

import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from numba import types

from particle import kernel_cache
from particle.kernel_cache import MAX_FOLDERS, PACKAGE, _Forms, cache_folder, place_of, source_digest

EVENTS = ("events", *(f"events/{room}" for room in ("mechanics", "rest", "sliding", "flight")))
ROOMS = ("body", "film", "", "drives", "friction", "surface", *EVENTS, "fixed")
USE = """
import os
import numpy as np
from particle.events.mechanics.equations import Part
from particle.events.contact_state import rest_loads
from particle.surface.at_point import POINT_SIZE, SurfacePoint
from particle import ConstantFriction
law = ConstantFriction(1.0)
law.friction_limit(1.0)
level = SurfacePoint(*np.zeros(POINT_SIZE))._replace(w_tt=1.0, x_x=1.0, y_y=1.0)
import particle
assert particle.__file__.startswith(os.getcwd())
loads, _ = rest_loads(np.array([level]), Part(1.0, 9.0, 0.0, 0.0, 2.0, law.law))
print(loads[0], sum(rest_loads.stats.cache_misses.values()))
"""
# A room of another package, with a kernel that calls one of its own and one of `particle`.
ROOM = {
    "one.py": """
from particle import kernel_no_arrays
@kernel_no_arrays
def twice(x):
    return 2.0 * x
""",
    "two.py": """
from particle import kernel
from particle.drives import breakpoint_slack
from other.room.one import twice
@kernel
def answer(table):
    return twice(1.0) + breakpoint_slack(table, 0, 0.0)
""",
}
USE_ROOM = """
import os
from particle import Drive
from particle.drives import drive_table
from other.room.two import answer
import particle
assert particle.__file__.startswith(os.getcwd())
print(answer(drive_table([Drive(1.0, 0.5)])), sum(answer.stats.cache_misses.values()))
"""


@pytest.fixture
def package(tmp_path):
    """A copy of the package."""
    return shutil.copytree(PACKAGE, tmp_path / "particle", ignore=shutil.ignore_patterns("__pycache__"))


@pytest.fixture(autouse=True)
def no_settings(monkeypatch, tmp_path):
    monkeypatch.setattr(kernel_cache.config, "CACHE_DIR", "")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "user"))


def test_an_edit_of_any_source_in_any_room_gives_another_folder(package):
    before = {source_digest(package)}
    assert before == {source_digest(PACKAGE)}  # wherever the package lies
    for room in ROOMS:
        for source in sorted((package / room).glob("*.py")):
            source.write_text(source.read_text() + "\n# edited\n")
            before.add(source_digest(package))
    assert len(before) == 1 + len(list(package.rglob("*.py")))


def test_the_cache_lies_where_the_user_wants_it_else_beside_the_sources(package, monkeypatch, tmp_path):
    assert cache_folder(package, "abc") == package / "__pycache__" / "kernels-abc"
    monkeypatch.setattr(kernel_cache.config, "CACHE_DIR", str(tmp_path / "own"))
    assert cache_folder(package, "abc") == tmp_path / "own" / "active-surface" / "kernels-abc"


@pytest.mark.skipif(sys.platform != "linux", reason="the user's folder is set as on Linux")
def test_a_folder_that_cannot_be_written_to_is_passed_over(package, monkeypatch, tmp_path):
    (package / "__pycache__").write_text("a file in its place")
    assert cache_folder(package, "abc") == tmp_path / "user" / "active-surface" / "kernels-abc"
    monkeypatch.setattr(kernel_cache.config, "CACHE_DIR", str(package / "__pycache__"))
    assert cache_folder(package, "abc") == tmp_path / "user" / "active-surface" / "kernels-abc"
    shutil.rmtree(tmp_path / "user")
    (tmp_path / "user").write_text("another one")
    assert cache_folder(package, "abc") is None


def test_only_the_folders_used_last_are_kept(package):
    for k in range(MAX_FOLDERS + 2):
        folder = cache_folder(package, f"{k}")
        assert folder
        (folder / "kernel.nbc").write_bytes(b"")
        os.utime(folder, (k, k))
    assert cache_folder(package, "2")  # used again
    assert cache_folder(package, "new")
    kept = {folder.name.removeprefix("kernels-") for folder in (package / "__pycache__").iterdir()}
    assert kept == {"2", "new", *(f"{k}" for k in range(4, MAX_FOLDERS + 2))}


def test_kernels_of_other_rooms_have_folders_of_their_own(tmp_path, monkeypatch):
    from coupling.stretch.newton import find_rates
    from particle.drives import drive_piece

    def place(kernel):
        return place_of(getattr(kernel, "py_func", kernel))

    monkeypatch.setattr(kernel_cache.config, "CACHE_DIR", str(tmp_path))
    inside, outside = place(drive_piece), place(find_rates)
    assert inside.packages == (PACKAGE,)
    assert outside.packages == (PACKAGE.parent / "coupling" / "stretch", PACKAGE)
    assert inside.folder.name == f"kernels-{source_digest(PACKAGE)}"
    assert outside.folder.name == f"stretch-kernels-{source_digest(*outside.packages)}"
    # One kind of folders does not drive out the other.
    for k in range(MAX_FOLDERS + 2):
        cache_folder(PACKAGE, f"{k}")
    assert cache_folder(PACKAGE, "of a room", "stretch-kernels-").exists()
    kept = [folder.name for folder in (tmp_path / "active-surface").iterdir()]
    assert "stretch-kernels-of a room" in kept
    assert sum(name.startswith("kernels-") for name in kept) == MAX_FOLDERS


def start(package: Path, cache: Path, use: str = USE) -> subprocess.Popen[str]:
    """A process in the folder of the package, so that it imports that."""
    settings = os.environ | {"NUMBA_CACHE_DIR": str(cache)}
    command = [sys.executable, "-c", use]
    return subprocess.Popen(command, cwd=package.parent, env=settings, stdout=subprocess.PIPE, text=True)


def result(process: subprocess.Popen[str]) -> tuple[float, int]:
    """The load, and how many kernels were compiled for it."""
    load, compiled = process.communicate(timeout=600)[0].split()
    return float(load), int(compiled)


@pytest.mark.slow
@pytest.mark.compiled
def test_a_kernel_is_compiled_once_and_anew_when_one_that_it_calls_has_changed(package, tmp_path):
    cache = tmp_path / "own"
    both = [start(package, cache), start(package, cache)]
    outputs = [result(process) for process in both]
    assert [load for load, _ in outputs] == [12.0, 12.0]
    assert sum(compiled for _, compiled in outputs) == 1
    assert result(start(package, cache)) == (12.0, 0)
    source = package / "events" / "mechanics" / "equations.py"
    text = source.read_text()
    assert text.count("+ part.squeeze") == 1
    time.sleep(1.1)  # Python itself looks at the second of an edit and at its size
    source.write_text(text.replace("+ part.squeeze", "- part.squeeze"))
    assert result(start(package, cache)) == (8.0, 1)
    time.sleep(1.1)
    source.write_text(text)
    assert result(start(package, cache)) == (12.0, 0)


@pytest.mark.slow
@pytest.mark.compiled
def test_a_kernel_of_another_room_is_compiled_anew_when_its_room_or_the_package_has_changed(package, tmp_path):
    room, cache = tmp_path / "other" / "room", tmp_path / "own"
    room.mkdir(parents=True)
    for name, text in ROOM.items():
        (room / name).write_text(text)
    assert result(start(package, cache, USE_ROOM)) == (2.0 + 1e-12, 1)
    assert result(start(package, cache, USE_ROOM)) == (2.0 + 1e-12, 0)
    time.sleep(1.1)  # Python itself looks at the second of an edit and at its size
    (room / "one.py").write_text(ROOM["one.py"].replace("2.0", "3.0"))
    assert result(start(package, cache, USE_ROOM)) == (3.0 + 1e-12, 1)
    record = package / "drives" / "pieces.py"
    text = record.read_text()
    assert text.count("MERGED = 1e-12") == 1
    record.write_text(text.replace("MERGED = 1e-12", "MERGED = 1e-11"))
    assert result(start(package, cache, USE_ROOM)) == (3.0 + 1e-11, 1)


KILLED = """
import os, signal
from particle import kernel_cache
replace, left = os.replace, 2
def counted(one, other):
    global left
    left -= 1
    if left == 0:
        os.kill(os.getpid(), signal.SIGKILL)
    replace(one, other)
os.replace = counted
"""


@pytest.mark.compiled
@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="has no SIGKILL")
def test_a_process_that_is_killed_as_it_keeps_a_kernel_leaves_nothing_wrong(package, tmp_path):
    """However many it has kept by then; what it has is used."""
    cache, killed = tmp_path / "own", 0
    while True:
        process = start(package, cache, KILLED + USE)
        text = process.communicate(timeout=600)[0]
        if process.returncode == 0:
            break
        assert process.returncode == -signal.SIGKILL
        killed += 1
        assert killed < 40
    assert float(text.split()[0]) == 12.0 and killed >= 1
    assert result(start(package, cache)) == (12.0, 0)


def test_a_form_is_kept_whole_or_not_at_all(tmp_path, monkeypatch):
    forms, others = _Forms(str(tmp_path), "kernel-1.py"), _Forms(str(tmp_path), "kernel-10.py")
    keys = [(types.float64,), (types.float64, types.int64)]
    for k, key in enumerate(keys):
        assert forms.load(key) is None
        forms.save(key, f"form {k}")
    others.save(keys[0], "another kernel's")
    assert [forms.load(key) for key in keys] == ["form 0", "form 1"]
    one, other = (forms._path(key) for key in keys)
    shutil.copy(other, one)
    assert [forms.load(key) for key in keys] == [None, "form 1"]
    for size in range(len(other.read_bytes())):
        one.write_bytes(other.read_bytes()[:size])
        assert forms.load(keys[0]) is None
    monkeypatch.setattr(kernel_cache.os, "replace", lambda *_: (_ for _ in ()).throw(KeyboardInterrupt))
    with pytest.raises(KeyboardInterrupt):
        forms.save(keys[1], "never")
    assert forms.load(keys[1]) == "form 1" and len(list(tmp_path.iterdir())) == 3
    forms.flush()
    assert forms.load(keys[1]) is None and others.load(keys[0]) == "another kernel's"


@pytest.mark.compiled
def test_kernels_are_kept_by_the_sources_of_all_rooms_that_they_call():
    from coupling.ringing.march import march

    rooms = {PACKAGE.parent / "coupling" / room for room in ("ringing", "stretch")}
    assert set(place_of(march.py_func).packages) == {PACKAGE, *rooms}
