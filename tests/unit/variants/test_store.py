"""A study is stored chunk by chunk, resumes, grows, and reports what it lacks."""

from __future__ import annotations

import errno
import os
from pathlib import Path

import numpy as np
import pytest

from tribodyn.checkpoints import NAME
from tribodyn.errors import ComputationError, InputError, OutputExistsError
from tribodyn.variants import open_study, read_study, run_study, study_state
from tribodyn.variants.store import Store

pytestmark = pytest.mark.usefixtures("cheap")

SPEED = 2.0 * np.pi / 60.0 * np.linspace(600.0, 1500.0, 10)


def grid(speeds: str = "600..1500 rpm:10", torques: str = "60,70,75 N*m", chunk: int = 4) -> str:
    return f"""
case = "fzg-roughness"
chunk = {chunk}
[axes]
operation.speed = "{speeds}"
operation.torque = "{torques}"
"""


def chunks(folder: Path) -> dict[str, bytes]:
    """Data of a store, byte for byte."""
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*.nc")}


def same(values, wanted) -> None:
    np.testing.assert_allclose(values, wanted, rtol=1e-14)


def power(torques: list[float], speed=SPEED) -> np.ndarray:
    return np.outer(speed, torques)


def test_a_store_gives_every_member_back(tmp_path: Path) -> None:
    state = run_study(read_study(grid()), tmp_path / "s")
    assert (state.members, state.done, state.failed) == (30, 30, 0)
    assert state.complete
    assert not state.running
    data = open_study(tmp_path / "s")
    same(data["power"].values, power([60.0, 70.0, 75.0]))
    np.testing.assert_allclose(data["operation.speed"], SPEED, rtol=1e-15)
    assert data["power"].attrs["units"] == "W"
    assert not data["failed"].values.any()
    some = data["power"].isel({"operation.speed": [7, 2], "operation.torque": -1})
    same(some, power([75.0])[[7, 2], 0])


def test_failed_runs_are_reported_and_the_others_go_on(tmp_path: Path) -> None:
    state = run_study(read_study(grid(torques="70,81,75,90 N*m", chunk=7)), tmp_path / "s")
    assert state.complete
    assert state.failed == 20
    assert {reason.split(" is")[0]: count for reason, count in state.reasons.items()} == {
        "torque of 81": 10, "torque of 90": 10,
    }  # fmt: skip
    data = open_study(tmp_path / "s")
    wanted = power([70.0, np.nan, 75.0, np.nan])
    same(data["power"], wanted)
    np.testing.assert_array_equal(data["failed"].values != "", np.isnan(wanted))
    assert study_state(tmp_path / "s").reasons == state.reasons


@pytest.mark.parametrize(
    ("speeds", "torques"),
    [
        ("600..1500 rpm:19", "60,70,75 N*m"),  # finer: the old values stand between new ones
        ("600..1500 rpm:10", "75,50,60,65,70 N*m"),
        ("500,600,700,800,900,1000,1100,1200,1300,1400,1500 rpm", "60,70,72,75 N*m"),
    ],
)
def test_a_study_grows(tmp_path: Path, speeds: str, torques: str) -> None:
    run_study(read_study(grid()), tmp_path / "s")
    before = chunks(tmp_path / "s")
    grown = read_study(grid(speeds, torques))
    assert run_study(grown, tmp_path / "s").complete
    after = chunks(tmp_path / "s")
    assert before.items() <= after.items()
    run_study(grown, tmp_path / "new")
    grown_data, other = (open_study(tmp_path / name).load() for name in ("s", "new"))
    assert dict(grown_data.sizes) == dict(other.sizes)
    for name in ("power", "operation.speed", "operation.torque"):
        np.testing.assert_allclose(grown_data[name], other[name], rtol=1e-12)
    # What was there is there once: each member is stored in one chunk.
    new = grown.layout.count - 30
    assert len(after) == len(before) + -(-new // 4)


def test_a_study_grows_while_it_is_unfinished_and_never_shrinks(tmp_path: Path) -> None:
    place = tmp_path / "s"
    with Store(read_study(grid()), place) as first:
        for chunk in first.left()[2:5]:
            first.put(chunk, first.job(chunk).stored())
    part = open_study(place)
    assert int((part["failed"] == "not computed yet").sum()) == 18
    assert study_state(place).done == 12
    assert run_study(read_study(grid(torques="60,70,75,50 N*m")), place).complete
    same(open_study(place)["power"], power([60.0, 70.0, 75.0, 50.0]))
    with pytest.raises(InputError, match="no longer has the value 50 N"):
        run_study(read_study(grid()), place)


def test_samples_and_tables_grow_at_their_end(tmp_path: Path) -> None:
    def samples(size: int, method: str = "sobol") -> str:
        return f"""
case = "fzg-roughness"
chunk = 5
samples.size = {size}
samples.seed = 3
samples.method = "{method}"
[samples.over]
operation.speed = "600 rpm .. 1500 rpm"
operation.torque = "60 N*m .. 75 N*m"
"""

    run_study(read_study(samples(8)), tmp_path / "s")
    run_study(read_study(samples(16)), tmp_path / "s")
    data = open_study(tmp_path / "s")
    assert data["power"].dims == ("member",)
    speed, torque = (data[f"operation.{name}"].values for name in ("speed", "torque"))
    same(data["power"].values, speed * torque)
    assert np.unique(speed).size == 16
    assert speed.min() >= SPEED[0]
    assert speed.max() <= SPEED[-1]
    run_study(read_study(samples(8, "latin-hypercube")), tmp_path / "l")
    with pytest.raises(InputError, match="the first 8 members are no longer"):
        run_study(read_study(samples(16, "latin-hypercube")), tmp_path / "l")


def test_a_damaged_chunk_is_refused_and_computed_anew(tmp_path: Path) -> None:
    place = tmp_path / "s"
    run_study(read_study(grid()), place)
    good = chunks(place)
    names = sorted(good)
    for name in names[:2]:
        content = bytearray(good[name])
        content[len(content) // 2] ^= 1
        (place / name).write_bytes(content)
    (place / names[2]).unlink()
    data = open_study(place)
    same(data["power"][9], power([60.0, 70.0, 75.0])[9])
    with pytest.raises(InputError, match="does not match its checksum"):
        data["power"].load()
    state = run_study(read_study(grid()), place)
    assert state.damaged == ("0/0", "0/1", "0/2")
    assert state.complete
    assert chunks(place) == good


def test_a_full_disk_is_reported_and_nothing_finished_is_lost(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    run_study(read_study(grid()), tmp_path / "whole")
    place, write, left = tmp_path / "s", Path.write_bytes, iter(range(3))

    def full(path: Path, content: bytes) -> int:
        if next(left, None) is None:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(path))
        return write(path, content)

    with monkeypatch.context() as patch:
        patch.setattr(Path, "write_bytes", full)
        with pytest.raises(ComputationError, match=r"no space left on device.*[Ff]ree some space"):
            run_study(read_study(grid()), place)
    assert study_state(place).done == 12
    assert run_study(read_study(grid()), place).complete
    assert chunks(place) == chunks(tmp_path / "whole")


def test_a_folder_that_cannot_be_written_is_reported_and_can_be_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    place = tmp_path / "s"
    run_study(read_study(grid()), place)
    opened = Path.open

    def read_only(path: Path, mode: str = "r", *options, **more):
        if path.name == NAME and mode != "r" and mode != "rb":
            raise OSError(errno.EROFS, os.strerror(errno.EROFS), str(path))
        return opened(path, mode, *options, **more)

    monkeypatch.setattr(Path, "open", read_only)
    with pytest.raises(InputError, match="cannot write: read-only file system"):
        run_study(read_study(grid(torques="60,70,75,77 N*m")), place)
    assert study_state(place).complete
    same(open_study(place)["power"], power([60.0, 70.0, 75.0]))


def test_two_writers_and_other_studies_are_refused(tmp_path: Path) -> None:
    place = tmp_path / "s"
    with Store(read_study(grid()), place):
        assert study_state(place).running
        with pytest.raises(InputError, match="Another process that is still active"):
            run_study(read_study(grid()), place)
    run_study(read_study(grid()), place)
    other = grid().replace("[axes]", "[set]\noperation.torque = '65 N*m'\n[axes]")
    with pytest.raises(InputError, match=r"[Ii]ts case differs"):
        run_study(
            read_study(
                other.replace("operation.torque = '65 N*m'", "dynamics.mesh_damping_ratio = 0.2")
            ),
            place,
        )
    assert run_study(read_study(grid("700,800 rpm").replace("summary", "summary")), tmp_path / "t")
    strange = tmp_path / "mine"
    strange.mkdir()
    (strange / "letter.txt").write_text("dear")
    for force in (False, True):
        with pytest.raises(OutputExistsError, match="it contains letter"):
            run_study(read_study(grid()), strange, force=force)
    with pytest.raises(InputError, match="not the store of a study"):
        open_study(strange)


def test_force_replaces_another_study(tmp_path: Path) -> None:
    place = tmp_path / "s"
    run_study(read_study(grid()), place)
    other = read_study(grid().replace('"fzg-roughness"', '"fzg-12dof"'))
    with pytest.raises(InputError, match=r"[Ii]ts case differs"):
        run_study(other, place)
    assert run_study(other, place, force=True).complete
    assert "12" in open_study(place).attrs["title"]


def test_a_wrong_path_gives_a_clear_message() -> None:
    with pytest.raises(InputError) as caught:
        open_study(5)  # type: ignore[arg-type]
    assert "Directory that run_study or tribodyn study wrote" in str(caught.value)


@pytest.mark.parametrize("study_path", ["map", "map.toml"])
def test_an_error_names_the_store_of_a_study_file(tmp_path: Path, study_path: str) -> None:
    (tmp_path / "map.toml").write_text("")
    with pytest.raises(InputError, match="the directory that tribodyn study wrote"):
        open_study(tmp_path / study_path)
    (tmp_path / "map-study").mkdir()
    with pytest.raises(InputError, match=r'Did you mean ".*map-study"\?'):
        open_study(tmp_path / study_path)


def test_lack_of_memory_is_no_error_of_a_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from tribodyn.variants import compute as computing

    def lacks(case, columns, progress):
        raise MemoryError("too little")

    kind = computing.KINDS["summary"]
    with monkeypatch.context() as patch:
        patch.setitem(computing.KINDS, "summary", computing.Kind("", lacks, kind.figures, 4))
        with pytest.raises(ComputationError, match="none of the first 3 chunks"):
            run_study(read_study(grid()), tmp_path / "s")
    assert study_state(tmp_path / "s").done == 0
    assert run_study(read_study(grid()), tmp_path / "s").failed == 0


@pytest.mark.parametrize("chunk", [1, 29, 30, 31])
def test_the_order_of_members_holds_for_every_chunk_size(tmp_path: Path, chunk: int) -> None:
    assert run_study(read_study(grid(chunk=chunk)), tmp_path / "s").complete
    same(open_study(tmp_path / "s")["power"], power([60.0, 70.0, 75.0]))
