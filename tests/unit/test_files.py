"""What takes a name is whole, what stood there is never gone, and leftovers are cleared."""

from __future__ import annotations

import errno
import os
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

import tribodyn.files as files
from tribodyn.errors import ComputationError, InputError, collected
from tribodyn.files import atomic_write, clear_leftovers, lock, reserved

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
with files.atomic_write(place, folder=True) as partial:
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
    with collected() as messages:
        clear_leftovers(place)
    assert (place / "summary.json").read_text() == holds
    assert os.listdir(tmp_path) == ["r"]
    assert {warning.code for warning in messages} == {"leftover"}


def test_without_exchange_a_failing_rename_brings_the_old_result_back(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    place = _old(tmp_path)
    monkeypatch.setattr(files, "_exchanger", lambda: None)
    rename, renamed = Path.rename, []

    def second_fails(self: Path, target: Path) -> Path:
        renamed.append(target)
        if len(renamed) == 2:
            raise OSError(errno.EIO, "I/O error")
        return rename(self, target)

    monkeypatch.setattr(Path, "rename", second_fails)
    with (
        pytest.raises(ComputationError, match="cannot write"),
        atomic_write(place, folder=True) as partial,
    ):
        (partial / "summary.json").write_text("new")
    assert (place / "summary.json").read_text() == "old"
    assert os.listdir(tmp_path) == ["r"]


def test_files_of_a_running_process_are_left_alone(tmp_path: Path) -> None:
    place = tmp_path / "r"
    with atomic_write(place, folder=True) as partial:
        clear_leftovers(place)
        assert partial.is_dir()
    stopped = tmp_path / ".r.0123abcd.part"
    stopped.mkdir()
    lock_file = lock(stopped)
    clear_leftovers(place)
    assert stopped.is_dir()
    os.close(lock_file)
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
    with collected() as messages:
        clear_leftovers(place)
    assert (place / "summary.json").read_text() == "old"
    assert os.listdir(tmp_path) == ["r"]
    assert len(messages) == 2


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
def test_an_impossible_file_name_is_reported(tmp_path: Path, name: str) -> None:
    with pytest.raises(InputError, match="cannot write"), atomic_write(tmp_path / name):
        pass


def test_a_full_disk_is_reported_with_the_path(tmp_path: Path) -> None:
    caught = pytest.raises(ComputationError, match="r: cannot write: no space")
    with caught, atomic_write(tmp_path / "r", folder=True):
        raise OSError(errno.ENOSPC, "no space left on device")
    assert os.listdir(tmp_path) == []


@pytest.mark.parametrize("root", ["/", "//", "/.."])
def test_the_root_directory_is_refused_as_a_result(root: str) -> None:
    writers = (clear_leftovers, lambda path: atomic_write(path).__enter__())
    for write in (*writers, lambda path: reserved(path).__enter__()):
        with pytest.raises(InputError, match="root directory"):
            write(Path(root))


#: Reserves a folder, reports it, and waits until it may write the result.
_WRITER = """
import sys
from pathlib import Path
from tribodyn.files import atomic_write, reserved
target = Path(sys.argv[1])
with reserved(target):
    print("reserved", flush=True)
    sys.stdin.readline()
    with atomic_write(target, folder=True) as partial:
        (partial / "summary.json").write_text("first")
"""


@pytest.fixture
def writer(tmp_path: Path) -> Iterator[subprocess.Popen[str]]:
    """Process that has reserved the folder ``r``."""
    command = [sys.executable, "-c", _WRITER, str(tmp_path / "r")]
    with subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "reserved\n"
        yield process
        process.kill()


def _write_second(target: Path) -> None:
    with atomic_write(target, folder=True) as partial:
        (partial / "summary.json").write_text("second")


@pytest.mark.skipif(os.name != "posix", reason="Windows has no such locks")
def test_a_second_writer_of_a_folder_is_refused(
    tmp_path: Path, writer: subprocess.Popen[str]
) -> None:
    target = tmp_path / "r"
    with pytest.raises(InputError, match=r"r: this directory is in use.*still active.*Wait"):
        _write_second(target)
    clear_leftovers(target)
    with pytest.raises(InputError, match="in use"):
        _write_second(target)
    writer.communicate("\n")
    assert (target / "summary.json").read_text() == "first"
    assert os.listdir(tmp_path) == ["r"]
    _write_second(target)
    assert (target / "summary.json").read_text() == "second"
    assert os.listdir(tmp_path) == ["r"]


@pytest.mark.skipif(os.name != "posix", reason="Windows has no such locks")
def test_a_killed_writer_leaves_no_stale_lock(
    tmp_path: Path, writer: subprocess.Popen[str]
) -> None:
    writer.kill()
    writer.wait()
    assert os.listdir(tmp_path) == [".r.lock"]
    _write_second(tmp_path / "r")
    assert os.listdir(tmp_path) == ["r"]


@pytest.mark.skipif(os.name != "posix", reason="Windows has no such locks")
def test_two_threads_do_not_write_one_folder(tmp_path: Path) -> None:
    failures: list[BaseException] = []

    def write() -> None:
        try:
            _write_second(tmp_path / "r")
        except InputError as error:
            failures.append(error)

    with reserved(tmp_path / "r"):
        thread = threading.Thread(target=write)
        thread.start()
        thread.join()
        _write_second(tmp_path / "r")
    assert len(failures) == 1
    assert "in use" in str(failures[0])


def test_what_is_written_inside_another_is_flushed_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    flushed: list[int] = []
    flush = os.fsync

    def counted(descriptor: int) -> None:
        flushed.append(os.fstat(descriptor).st_ino)
        flush(descriptor)

    monkeypatch.setattr(os, "fsync", counted)
    with atomic_write(tmp_path / "result", folder=True) as folder:
        with atomic_write(folder / "figures.csv") as partial:
            partial.write_text("1, 2")
        assert partial.name == "figures.csv"
    place = tmp_path / "result" / "figures.csv"
    assert place.read_text() == "1, 2"
    assert flushed.count(place.stat().st_ino) == 1
    assert place.parent.stat().st_ino in flushed
