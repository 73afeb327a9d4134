"""Where the words of the command line go: consoles without some letters, and none at all."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import warnings
from pathlib import Path

import pytest

from tribodyn.cli import entry
from tribodyn.errors import warn

_NO_OUTPUT = "import sys; sys.stdout = sys.stderr = None; from tribodyn.cli import main; main({!r})"


def _run(folder: Path, *arguments: str, encoding: str) -> subprocess.CompletedProcess[bytes]:
    environment = os.environ | {"PYTHONIOENCODING": encoding}
    call = [sys.executable, "-m", "tribodyn", *arguments]
    return subprocess.run(call, env=environment, capture_output=True, check=False, cwd=folder)


@pytest.mark.parametrize(("encoding", "output"), [("ascii", b"R?der"), ("cp1252", b"R\xe4der")])
def test_letters_that_a_console_lacks_are_replaced(
    tmp_path: Path, encoding: str, output: bytes
) -> None:
    done = _run(tmp_path, "new", "Räder.toml", encoding=encoding)
    assert done.returncode == 0, done.stderr
    assert output in done.stdout
    assert (tmp_path / "Räder.toml").is_file()


def test_json_is_whole_on_every_console(tmp_path: Path) -> None:
    outputs = [
        _run(tmp_path, "check", "Räder.toml", "--json", encoding=encoding).stdout
        for encoding in ("utf-8", "ascii")
    ]
    plain, ascii_ = (json.loads(text) for text in outputs)
    assert plain == ascii_
    assert "Räder.toml" in json.dumps(plain, ensure_ascii=False)


@pytest.mark.parametrize(("arguments", "code"), [(["cases"], 0), (["run", "no-such-case"], 2)])
def test_without_any_output_the_exit_code_remains(arguments: list[str], code: int) -> None:
    done = subprocess.run([sys.executable, "-c", _NO_OUTPUT.format(arguments)], check=False)
    assert done.returncode == code


def test_model_warnings_have_no_line_of_the_program(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def dispatch(_: list[str]) -> int:
        warn("friction-range", "The slip is small.")
        return 0

    monkeypatch.setattr(entry, "_dispatch", dispatch)
    before = warnings.showwarning
    with warnings.catch_warnings():
        warnings.simplefilter("always")
        assert entry.call([]) == 0
    assert warnings.showwarning is before
    assert capsys.readouterr().err == "warning [friction-range]: The slip is small.\n"


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs a device that is always full")
@pytest.mark.parametrize(
    ("arguments", "full", "code"),
    [
        (["cases"], "stdout", 1),
        (["cases", "--json"], "stdout", 1),
        (["explain", "epsilon_alpha"], "stdout", 1),
        (["check", "no-such-case", "--json"], "stdout", 2),
        (["check", "no-such-case", "--json"], "stderr", 2),
    ],
)
def test_a_full_disk_ends_in_one_message(arguments: list[str], full: str, code: int) -> None:
    command = [sys.executable, "-m", "tribodyn", *arguments]
    streams = dict.fromkeys(("stdout", "stderr"), subprocess.PIPE)
    with open("/dev/full", "w") as device:
        done = subprocess.run(command, text=True, check=False, **{**streams, full: device})
    assert done.returncode == code
    if full == "stderr":
        assert json.loads(done.stdout)["error"]["exit_code"] == code
    else:
        assert done.stderr.startswith("error: ")
        assert done.stderr.count("\n") == 1
        if code == 1:
            assert "standard output: cannot write: no space left" in done.stderr
