"""A study, and workers of a cluster, killed at any moment: the store becomes what it would be."""

from __future__ import annotations

import os
import random
import signal
from collections.abc import Callable, Iterator
from pathlib import Path
from threading import Timer

import numpy as np
import pytest
from killed import started

from tribodyn.variants import load_study, open_study, run_study, study_state

Draws = Callable[[int], Iterator[random.Random]]

#: 24 members in 8 chunks; a wheel of 90 teeth has no room in this housing.
STUDY = """
case = "fzg-roughness"
chunk = 3
[set]
stiffness.model = "iso6336"
friction.law = "none"
film.model = "none"
[axes]
operation.speed = "900..1500 rpm:6"
operation.torque = "60,90 N*m"
gears.wheel.teeth = [24, 90]
"""


def chunks(folder: Path) -> dict[str, bytes]:
    """Data of a store, byte for byte."""
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*.nc")}


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """Data of a study that nobody disturbed."""
    folder = tmp_path_factory.mktemp("whole")
    (folder / "s.toml").write_text(STUDY)
    assert run_study(load_study(folder / "s.toml"), folder / "s").complete
    return chunks(folder / "s")


def _finished(folder: Path, arguments: list[str]) -> dict[str, bytes]:
    """Go on to the end: nothing but the chunks and their manifest is there, which are returned."""
    process = started(folder, arguments)
    output = process.communicate(timeout=120)
    assert process.returncode == 0, output
    state = study_state(folder / "r")
    assert (state.done, state.failed) == (24, 12)
    assert int(np.isfinite(open_study(folder / "r")["rms_mesh_force"]).sum()) == 12
    stored = chunks(folder / "r")
    names = {path.name for path in (folder / "r").rglob("*") if path.is_file()}
    assert names == {"members.jsonl", *(Path(name).name for name in stored)}
    return stored


def _disturbed(rng: random.Random, folder: Path, arguments: list[str]) -> None:
    """Begin or go on, and be killed at a call of the system or after a while."""
    aimed = rng.random() < 0.7
    process = started(folder, arguments, rng.randrange(1, 240) if aimed else 0)
    if not aimed:
        Timer(rng.uniform(0.5, 4.0), process.kill).start()
    process.communicate(timeout=120)
    assert process.returncode in (0, -signal.SIGKILL)


@pytest.mark.slow
def test_a_study_killed_at_any_moment(
    draws: Draws, tmp_path: Path, undisturbed: dict[str, bytes]
) -> None:
    arguments = ["study", "s.toml", "--out", "r"]
    for number, rng in enumerate(draws(1)):
        folder = tmp_path / str(number)
        folder.mkdir()
        (folder / "s.toml").write_text(STUDY)
        for _ in range(rng.choice((1, 2))):
            _disturbed(rng, folder, arguments)
        assert _finished(folder, arguments) == undisturbed


@pytest.mark.slow
def test_workers_of_a_cluster_killed_at_any_moment(
    draws: Draws, tmp_path: Path, undisturbed: dict[str, bytes]
) -> None:
    distributed = pytest.importorskip("distributed")
    for number, rng in enumerate(draws(1)):
        folder = tmp_path / str(number)
        folder.mkdir()
        (folder / "s.toml").write_text(STUDY)
        # One of its own, as a nanny now and then fails to bring a killed worker back.
        with (
            distributed.LocalCluster(
                n_workers=2, threads_per_worker=1, dashboard_address=None
            ) as cluster,
            distributed.Client(cluster) as client,
        ):
            arguments = ["study", "s.toml", "--out", "r", "--scheduler", cluster.scheduler_address]
            if rng.random() < 0.5:
                _disturbed(rng, folder, arguments)
            workers = client.run(os.getpid)
            victim = rng.choice(list(workers.values()))
            timer = Timer(rng.uniform(0.0, 4.0), os.kill, (victim, signal.SIGKILL))
            timer.start()
            try:
                assert _finished(folder, arguments) == undisturbed
            finally:
                timer.join()
