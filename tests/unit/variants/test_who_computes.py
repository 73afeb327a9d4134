"""Who computes: clear words where no cluster answers, and where a worker is another one."""

from __future__ import annotations

import socket
from dataclasses import replace
from pathlib import Path

import pytest

from tribodyn.errors import InputError
from tribodyn.mesh.film import tabled_film
from tribodyn.variants import read_study, run_study
from tribodyn.variants.compute import KINDS, Job, Part
from tribodyn.variants.run import compute_alone

_STUDY = 'case = "fzg-roughness"\n[axes]\noperation.speed = "400..900 rpm:3"\n'


def _nobody() -> str:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        return f"tcp://127.0.0.1:{free.getsockname()[1]}"


@pytest.mark.parametrize("address", ["", "nonsense", "127.0.0.1:99999", "tcp://:x"])
def test_a_scheduler_that_does_not_answer_is_told(tmp_path: Path, address: str) -> None:
    pytest.importorskip("distributed")
    address = address or _nobody()
    with pytest.raises(InputError, match=f"no Dask scheduler answers at {address}.*dask scheduler"):
        run_study(read_study(_STUDY), tmp_path / "s", scheduler=address)
    assert not (tmp_path / "s").exists()


def test_a_worker_of_another_version_refuses() -> None:
    study = read_study(_STUDY)
    job = Job(study.compute, study.case, (), {"operation.speed": [100.0]})
    with pytest.raises(InputError, match=r"a worker has version .* the study 0\.0\.0"):
        compute_alone("0.0.0", job)


def test_chunks_of_a_study_share_their_solved_films(monkeypatch: pytest.MonkeyPatch) -> None:
    tables = []

    def compute(*_: object) -> Part:
        tables.append(tabled_film._shared.get())
        return Part({}, [""], [""])

    monkeypatch.setitem(KINDS, "summary", replace(KINDS["summary"], compute=compute))
    study = read_study(_STUDY)
    for speed in (100.0, 110.0):
        Job("summary", study.case, (), {"operation.speed": [speed]}).compute()
    assert isinstance(tables[0], tabled_film._Shared)
    assert tables[0] is tables[1]
    with tabled_film.shared_films():
        assert tabled_film._shared.get() not in (None, tables[0])
