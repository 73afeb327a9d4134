"""Messages where no cluster answers, and where a worker has another version."""

from __future__ import annotations

import re
import socket
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from threading import Timer

import pytest

from tribodyn.errors import InputError, collected
from tribodyn.mesh.film import film_lookup
from tribodyn.variants import read_study, run, run_study
from tribodyn.variants.compute import KINDS, Job, Part
from tribodyn.variants.run import compute_alone

_STUDY = 'case = "fzg-roughness"\n[axes]\noperation.speed = "400..900 rpm:3"\n'


def _nobody() -> str:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        return f"tcp://127.0.0.1:{free.getsockname()[1]}"


@pytest.mark.parametrize("address", ["", "nonsense", "127.0.0.1:99999", "tcp://:x"])
def test_a_scheduler_that_does_not_answer_is_reported(tmp_path: Path, address: str) -> None:
    pytest.importorskip("distributed")
    address = address or _nobody()
    with pytest.raises(InputError, match=f"no Dask scheduler answers at {address}.*dask scheduler"):
        run_study(read_study(_STUDY), tmp_path / "s", scheduler=address)
    assert not (tmp_path / "s").exists()


@pytest.mark.slow
def test_a_cluster_without_workers_is_waited_for(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    distributed = pytest.importorskip("distributed")
    monkeypatch.setattr(run, "_PATIENCE", 0.5)
    nobody = {"n_workers": 0, "threads_per_worker": 1, "dashboard_address": None}
    with distributed.LocalCluster(**nobody) as cluster, collected() as messages:
        Timer(2.0, cluster.scale, (1,)).start()
        state = run_study(read_study(_STUDY), tmp_path / "s", scheduler=cluster.scheduler_address)
        assert state.complete
        assert [warning.code for warning in messages] == ["no-workers"]
        assert f"dask worker {cluster.scheduler_address}" in str(messages[0])


def _dask(log: Path, *arguments: str) -> subprocess.Popen[bytes]:
    command = [sys.executable, "-m", "distributed.cli.dask_scheduler", *arguments]
    with log.open("wb") as sink:
        return subprocess.Popen(command, stdout=sink, stderr=sink)


@pytest.mark.slow
def test_a_lost_scheduler_is_reported_in_one_line(tmp_path: Path) -> None:
    """Dask writes pages of its own to the screen otherwise."""
    pytest.importorskip("distributed")
    (tmp_path / "s.toml").write_text(_STUDY)
    log = tmp_path / "log"
    scheduler = _dask(log, "--port", "0", "--no-dashboard")
    try:
        while not (address := re.search(r"Scheduler at: +(\S+)", log.read_text())):
            assert scheduler.poll() is None, log.read_text()
        command_line = [
            "study",
            "s.toml",
            "--scheduler",
            address[1].replace("0.0.0.0", "127.0.0.1"),
        ]
        command = [sys.executable, "-m", "tribodyn", *command_line]
        study = subprocess.Popen(command, cwd=tmp_path, stderr=subprocess.PIPE, text=True)
        while not (tmp_path / "s-study" / "members.jsonl").exists():
            assert study.poll() is None
    finally:
        scheduler.kill()
        scheduler.wait()
    _, errors = study.communicate(timeout=120)
    assert study.returncode == 1
    assert len(errors.splitlines()) == 1, errors
    assert re.search("the Dask scheduler at .* is lost.*the same command continues", errors)


def test_a_worker_of_another_version_refuses() -> None:
    study = read_study(_STUDY)
    job = Job(study.compute, study.case, (), {"operation.speed": [100.0]})
    with pytest.raises(InputError, match=r"a worker has version .* the study 0\.0\.0"):
        compute_alone("0.0.0", job)


def test_chunks_of_a_study_share_their_solved_films(monkeypatch: pytest.MonkeyPatch) -> None:
    tables = []

    def compute(*_: object) -> Part:
        tables.append(film_lookup._shared.get())
        return Part({}, [""], [""])

    monkeypatch.setitem(KINDS, "summary", replace(KINDS["summary"], compute=compute))
    study = read_study(_STUDY)
    for speed in (100.0, 110.0):
        Job("summary", study.case, (), {"operation.speed": [speed]}).compute()
    assert isinstance(tables[0], film_lookup._Shared)
    assert tables[0] is tables[1]
    with film_lookup.shared_films():
        assert film_lookup._shared.get() not in (None, tables[0])
