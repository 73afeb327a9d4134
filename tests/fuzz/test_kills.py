"""Kills at any moment: a whole result or none, and the same command goes on to the end."""

from __future__ import annotations

import json
import os
import random
import signal
from collections.abc import Callable, Iterator
from pathlib import Path
from threading import Timer

import pytest
from killed import started

from tribodyn.validated_files import read_dataset

Draws = Callable[[int], Iterator[random.Random]]

_QUICK = [
    "--set",
    "stiffness.model=iso6336",
    "--set",
    "friction.law=none",
    "--set",
    "film.model=none",
]
#: Command and the file of its result that comes last.
_COMMANDS = {
    "run": (["run", "fzg-roughness", *_QUICK], "report.html"),
    "sweep": (
        ["sweep", "fzg-roughness", "operation.speed=900..1500 rpm:5", *_QUICK], "report.html",
    ),
    "bifurcation": (
        ["bifurcation", "fzg-roughness", "operation.torque=60..120 N*m:4", "--sweep", "both",
         "--transient", "60", *_QUICK],
        "bifurcation.html",
    ),
}  # fmt: skip


def _is_whole(place: Path, last: str) -> bool:
    """Whether a result is there; half of one is a failure."""
    if not place.exists():
        return False
    names = set(os.listdir(place))
    assert {"case.toml", last} <= names
    assert (place / last).read_text(encoding="utf-8").rstrip().endswith("</html>")
    if "summary.json" in names:
        json.loads((place / "summary.json").read_text())
    for name in names:
        if name.endswith(".nc"):
            read_dataset(place / name)
    return True


@pytest.mark.slow
@pytest.mark.parametrize("command", sorted(_COMMANDS))
def test_kills_at_any_moment(draws: Draws, tmp_path: Path, command: str) -> None:
    arguments, last = _COMMANDS[command]
    place = tmp_path / "r"
    arguments = [*arguments, "--out", "r"]
    for number, rng in enumerate(draws(2)):
        complete = _is_whole(place, last)
        assert complete == (number > 0)
        forced = [*arguments, "--force"] if complete else arguments
        for _ in range(rng.choice((1, 2))):
            if rng.random() < 0.7:
                process = started(tmp_path, forced, rng.randrange(1, 90))
                process.communicate(timeout=120)
            else:
                process = started(tmp_path, forced)
                Timer(rng.uniform(0.5, 6.0), process.kill).start()
                process.communicate(timeout=120)
            assert process.returncode in (0, -signal.SIGKILL)
            assert _is_whole(place, last) or not complete
            complete = _is_whole(place, last)
            forced = [*arguments, "--force"] if complete else arguments
        process = started(tmp_path, forced)
        output = process.communicate(timeout=120)
        assert process.returncode == 0, output
        assert _is_whole(place, last)
        assert os.listdir(tmp_path) == ["r"]
