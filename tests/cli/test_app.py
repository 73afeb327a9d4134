"""``tribodyn app``: how it begins, ends, and what it says when it cannot begin."""

from __future__ import annotations

import re
import signal
import socket
import subprocess
import sys
import webbrowser
from http.client import HTTPConnection
from importlib import util
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("dash", reason="the page needs Dash")

from tribodyn.app.server import Page
from tribodyn.cli import call


def test_it_serves_until_it_is_interrupted(tmp_path: Path) -> None:
    arguments = ["-m", "tribodyn", "app", "--no-browser", "--port", "0", "--folder", str(tmp_path)]
    served = subprocess.Popen([sys.executable, *arguments], stderr=subprocess.PIPE, text=True)
    address = served.stderr.readline()
    port, token = re.findall(r"127\.0\.0\.1:(\d+)/\?token=(\S+)", address)[0]
    connection = HTTPConnection("127.0.0.1", int(port))
    for path, status in (("/", 403), (f"/?token={token}", 303)):
        connection.request("GET", path)
        answer = connection.getresponse()
        answer.read()
        assert answer.status == status
    connection.close()
    served.send_signal(signal.SIGINT)
    errors = served.communicate(timeout=60)[1]
    assert served.returncode == 0
    assert "The page has ended." in errors
    assert token not in errors


@pytest.fixture
def brief(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Page, "serve", Page.close)


@pytest.mark.usefixtures("brief")
def test_without_a_browser_the_address_is_printed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(webbrowser, "open", lambda address: False)
    assert call(["app", "--port", "0", "--folder", str(tmp_path)]) == 0
    error = capsys.readouterr().err
    assert "http://127.0.0.1:" in error
    assert "open the address in one yourself" in error


def refused(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> str:
    assert call(["app", "--no-browser", "--port", "0", *arguments]) == 2
    return capsys.readouterr().err


def test_a_port_that_is_taken(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))
        other.listen()
        port = str(other.getsockname()[1])
        arguments = ["app", "--no-browser", "--port", port, "--folder", str(tmp_path)]
        assert call(arguments) == 2
    assert "--port" in capsys.readouterr().err


def test_wrong_arguments_are_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder_option = ["--folder", str(tmp_path)]
    bad, away = tmp_path / "bad.toml", tmp_path.parent / "away.toml"
    bad.write_text('title = "x"\n[gears]\nteeth = 3\n')
    away.write_text("title = 1\n")
    assert "there is no folder" in refused(["--folder", str(tmp_path / "no")], capsys)
    assert "no built-in case" in refused(["no-such-case", *folder_option], capsys)
    assert "bad.toml:3" in refused([str(bad), *folder_option], capsys)
    assert "--folder" in refused([str(away), *folder_option], capsys)
    assert "cannot serve at" in refused(["--host", "203.0.113.1", *folder_option], capsys)
    assert call(["app", "--port", "70000", *folder_option]) == 2


def test_without_dash_the_extra_is_named(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    find_spec = util.find_spec

    def lacking(name: str, *more: Any) -> Any:
        return None if name == "dash" else find_spec(name, *more)

    monkeypatch.setattr(util, "find_spec", lacking)
    assert 'pip install "tribodyn[app]"' in refused([], capsys)
