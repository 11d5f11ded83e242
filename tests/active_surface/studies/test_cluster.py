"""Sweeps on a dask cluster: the same bits as without, whatever becomes of the workers, and clear words."""

import os
import re
import signal
import socket
import sys

import numpy as np
import pytest
from click.testing import CliRunner
from sweeps import PLATE, PLATFORM, written

from active_surface.cli.program import main
from active_surface.studies import read_study, run_study
from active_surface.studies.cluster import AHEAD, records_on
from active_surface.studies.engine import Engine

SHAKEN = """\
[[axes]]
field = "plate.motion.x.stroke"
name = "stroke"
range = ["5 um", "40 um"]
count = 12
[[axes]]
field = "part.position.0"
values = ["0 um", "10 um"]
"""
PLATES = """\
sampling = "random"
points = 40
[[axes]]
field = "plate.thickness"
values = ["5 um", "6 um"]
[[axes]]
field = "actuators.*.frequency"
range = ["350 Hz", "500 Hz"]
"""

pytestmark = pytest.mark.filterwarnings("default")  # those of dask are its own


@pytest.fixture(scope="module")
def cluster():
    """Two workers of one thread in processes of their own, which are started again when they die."""
    distributed = pytest.importorskip("distributed")
    options = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": ":0"}
    with distributed.LocalCluster(**options) as made:
        yield made


def workers(cluster):
    """The process ids of the workers by address."""
    from distributed import Client

    with Client(cluster, set_as_default=False) as client:
        client.wait_for_workers(2)
        return client.run(os.getpid)


def bits(dataset):
    return {name: dataset[name].values.tobytes() for name in dataset.variables}


@pytest.mark.slow
def test_the_bits_are_those_of_a_sweep_without_a_cluster(tmp_path, cluster):
    study, told = read_study(written(tmp_path, SHAKEN, PLATFORM)), []
    found = run_study(study, tell=lambda done, of: told.append((done, of)), scheduler=cluster.scheduler_address)
    assert bits(found.dataset) == bits(run_study(study).dataset)
    assert told[-1] == (24, 24)


@pytest.mark.slow
def test_a_killed_worker_costs_nothing_but_time(tmp_path, cluster):
    """One is killed as the first chunk comes in, while others are under way."""
    study = read_study(written(tmp_path, PLATES, PLATE))
    killed = []

    def tell(done, of):
        if not killed:
            assert done < of
            killed.append(next(iter(pids.values())))
            os.kill(killed[0], signal.SIGKILL)

    pids = workers(cluster)
    assert len(Engine(study).chunks(np.arange(len(study.points)))) > 10
    found = run_study(study, tmp_path / "out", tell=tell, scheduler=cluster.scheduler_address)
    assert killed and killed[0] not in workers(cluster).values()
    assert found.outcomes.get("refused", 0) == 0
    assert bits(found.dataset) == bits(run_study(study).dataset)


@pytest.mark.slow
def test_few_chunks_are_under_way_at_a_time(tmp_path, cluster):
    axes = SHAKEN.replace("count = 12", "count = 2")
    engine, asked = Engine(read_study(written(tmp_path, axes, PLATFORM))), []
    alone = engine.records(range(4)).tobytes()

    def chunks():
        for _ in range(24):
            asked.append(0)
            yield np.arange(4)

    ahead = []
    for n, (chunk, found) in enumerate(records_on(cluster.scheduler_address, engine, chunks())):
        ahead.append(len(asked) - n)
        assert chunk.tolist() == [0, 1, 2, 3] and found.tobytes() == alone
    assert len(asked) == len(ahead) == 24 and max(ahead) <= 2 * AHEAD + 1


@pytest.mark.slow
def test_a_worker_with_another_version_is_refused(tmp_path, cluster, monkeypatch):
    study = read_study(written(tmp_path, SHAKEN, PLATFORM))
    own = {"active-surface": "9.8.7", "numpy": np.__version__}
    monkeypatch.setattr("active_surface.studies.cluster.versions", lambda: own)
    with pytest.raises(ValueError) as caught:
        run_study(study, scheduler=cluster.scheduler_address)
    said = (
        r"the worker at tcp://\S+ must have the same versions as the command; it has active-surface \S+ in place of 9"
    )
    assert re.match(said, str(caught.value))


@pytest.mark.slow
def test_a_worker_that_reads_other_files_is_refused(tmp_path, cluster, monkeypatch):
    study = read_study(written(tmp_path, SHAKEN, PLATFORM))
    monkeypatch.setattr(type(study), "key", "ab" * 32)
    with pytest.raises(ValueError, match=r"^the worker at tcp://\S+ must have the same files"):
        run_study(study, scheduler=cluster.scheduler_address)


def refused(tmp_path, address):
    """What the command says to an address that it refuses."""
    pytest.importorskip("distributed")
    path = written(tmp_path, SHAKEN, PLATFORM)
    done = CliRunner().invoke(main, ["sweep", str(path), "-o", str(tmp_path / "out"), "--scheduler", address])
    assert done.exit_code == 2 and not (tmp_path / "out").exists()
    said, got = done.output.split(f"; got {address!r}: ")
    wanted = "the address of a running dask scheduler such as tcp://127.0.0.1:8786"
    assert said == f"main sweep: 1 mistake\n  --scheduler must be {wanted}"
    assert got.count("\n") == 1
    return got.strip()


@pytest.mark.parametrize("address", ["nowhere", "", "tcp://127.0.0.1", "tcp://127.0.0.1:port"])
def test_what_is_no_address_is_one_clear_error(tmp_path, address):
    assert refused(tmp_path, address)


def test_an_address_where_nobody_listens_is_one_clear_error(tmp_path):
    assert refused(tmp_path, "tcp://127.0.0.1:9") == "no dask scheduler answered there in 5 s"


@pytest.mark.slow
def test_an_address_where_something_else_listens_is_one_clear_error(tmp_path, cluster):
    with socket.create_server(("127.0.0.1", 0)) as silent:
        address = "tcp://{}:{}".format(*silent.getsockname())
        assert refused(tmp_path, address) == "no dask scheduler answered there in 5 s"
    assert refused(tmp_path, next(iter(workers(cluster)))) == "there is a dask worker at that address"


@pytest.mark.slow
def test_a_scheduler_without_workers_is_one_clear_error(tmp_path, monkeypatch):
    distributed = pytest.importorskip("distributed")
    monkeypatch.setattr("active_surface.studies.cluster.ARRIVAL", 1)
    study = read_study(written(tmp_path, SHAKEN, PLATFORM))
    with distributed.LocalCluster(n_workers=0, dashboard_address=":0") as empty, pytest.raises(RuntimeError) as caught:
        run_study(study, scheduler=empty.scheduler_address)
    assert str(caught.value).startswith("Input scheduler must have workers; the one at tcp://127.0.0.1:")


@pytest.mark.slow
def test_a_scheduler_that_goes_is_one_clear_error(tmp_path, monkeypatch):
    distributed = pytest.importorskip("distributed")
    monkeypatch.setattr(Engine, "_chunk_length", lambda engine: 2)
    study = read_study(written(tmp_path, SHAKEN, PLATFORM))
    options = {"n_workers": 1, "threads_per_worker": 1, "dashboard_address": ":0"}
    with distributed.LocalCluster(**options) as going, pytest.raises(RuntimeError, match="is gone; the same command"):
        run_study(study, tmp_path, tell=lambda done, of: going.close(), scheduler=going.scheduler_address)
    assert (tmp_path / "study.sweep").exists()


def test_without_dask_the_command_says_how_to_get_it(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    path = written(tmp_path, SHAKEN, PLATFORM)
    done = CliRunner().invoke(main, ["sweep", str(path), "-o", str(tmp_path), "--scheduler", "tcp://127.0.0.1:9"])
    assert done.exit_code == 2 and "pip install 'active-surface[cluster]'" in done.output


def test_threads_are_those_of_the_workers(tmp_path):
    path = written(tmp_path, SHAKEN, PLATFORM)
    done = CliRunner().invoke(main, ["sweep", str(path), "--scheduler", "tcp://127.0.0.1:9", "--threads", "2"])
    assert done.exit_code == 2 and "each worker uses all of its own threads" in done.output
