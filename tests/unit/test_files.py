"""What takes a name is whole, what stood there is never gone, and leftovers are cleared."""

from __future__ import annotations

import errno
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

import tribodyn.files as files
from tribodyn.errors import ComputationError, InputError, collected
from tribodyn.files import clear_leftovers, lock, whole

#: Publishes "new" over "old" and is killed when it calls os.NAME or the exchange.
_KILLED = """
import os, signal, sys
from pathlib import Path
import tribodyn.files as files
place, at = Path(sys.argv[1]), sys.argv[2]
def die(*_):
    os.kill(os.getpid(), signal.SIGKILL)
if at.startswith("two-step"):
    files._exchanger = lambda: None
    rename, seen = Path.rename, []
    def counted(self, target):
        seen.append(target)
        if len(seen) == int(at[-1]):
            die()
        return rename(self, target)
    Path.rename = counted
elif at == "before":
    files._exchange = die
else:
    exchange = files._exchange
    def then(*names):
        exchange(*names)
        die()
    files._exchange = then
with files.whole(place, folder=True) as partial:
    (partial / "summary.json").write_text("new")
"""


def _old(tmp_path: Path) -> Path:
    place = tmp_path / "r"
    place.mkdir()
    (place / "summary.json").write_text("old")
    return place


@pytest.mark.parametrize(
    ("at", "holds"),
    [("before", "old"), ("after", "new"), ("two-step 1", "old"), ("two-step 2", "old")],
)
def test_a_kill_leaves_the_old_or_the_new_result(tmp_path: Path, at: str, holds: str) -> None:
    place = _old(tmp_path)
    done = subprocess.run([sys.executable, "-c", _KILLED, str(place), at], check=False)
    assert done.returncode == -signal.SIGKILL
    if not at.startswith("two-step"):
        assert (place / "summary.json").read_text() == holds
    with collected() as told:
        clear_leftovers(place)
    assert (place / "summary.json").read_text() == holds
    assert os.listdir(tmp_path) == ["r"]
    assert {warning.code for warning in told} == {"leftover"}


def test_without_exchange_a_failing_rename_brings_the_old_result_back(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    place = _old(tmp_path)
    monkeypatch.setattr(files, "_exchanger", lambda: None)
    rename, seen = Path.rename, []

    def second_fails(self: Path, target: Path) -> Path:
        seen.append(target)
        if len(seen) == 2:
            raise OSError(errno.EIO, "I/O error")
        return rename(self, target)

    monkeypatch.setattr(Path, "rename", second_fails)
    with (
        pytest.raises(ComputationError, match="cannot write"),
        whole(place, folder=True) as partial,
    ):
        (partial / "summary.json").write_text("new")
    assert (place / "summary.json").read_text() == "old"
    assert os.listdir(tmp_path) == ["r"]


def test_what_a_living_process_writes_is_left_alone(tmp_path: Path) -> None:
    place = tmp_path / "r"
    with whole(place, folder=True) as partial:
        clear_leftovers(place)
        assert partial.is_dir()
    stopped = tmp_path / ".r.0123abcd.part"
    stopped.mkdir()
    held = lock(stopped)
    clear_leftovers(place)
    assert stopped.is_dir()
    os.close(held)
    with collected():
        clear_leftovers(place)
    assert not stopped.exists()


def test_leftovers_of_the_earlier_version(tmp_path: Path) -> None:
    place = tmp_path / "r"
    aside = tmp_path / ".r.old.k2_x9abc" / "r"
    aside.mkdir(parents=True)
    (aside / "summary.json").write_text("old")
    unfinished = tmp_path / ".r.k2_x9abc"
    unfinished.mkdir()
    (unfinished / "case.toml").write_text("x")
    with collected() as told:
        clear_leftovers(place)
    assert (place / "summary.json").read_text() == "old"
    assert os.listdir(tmp_path) == ["r"]
    assert len(told) == 2


def test_a_copy_of_the_user_is_no_leftover(tmp_path: Path) -> None:
    for name, file in (
        (".r.20250101", "report.html"),
        (".r.backup", "x"),
        (".r2.0123abcd.part", "x"),
    ):
        (tmp_path / name).mkdir()
        (tmp_path / name / file).write_text("x")
    clear_leftovers(tmp_path / "r")
    assert len(os.listdir(tmp_path)) == 3


@pytest.mark.parametrize("name", ["x" * 300, "a\0b"])
def test_a_name_that_no_disk_takes_is_told(tmp_path: Path, name: str) -> None:
    with pytest.raises(InputError, match="cannot write"), whole(tmp_path / name):
        pass


def test_a_full_disk_is_told_with_the_place(tmp_path: Path) -> None:
    told = pytest.raises(ComputationError, match="r: cannot write: no space")
    with told, whole(tmp_path / "r", folder=True):
        raise OSError(errno.ENOSPC, "no space left on device")
    assert os.listdir(tmp_path) == []
