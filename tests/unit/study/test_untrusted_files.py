"""Files that a case names are not trusted: nothing is waited for, leaked or repeated in full."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from broken import SOUND

from tribodyn import load_case
from tribodyn.errors import InputError, Problem, TribodynError
from tribodyn.mesh.table_file import read_table_file
from tribodyn.study import read_case, run
from tribodyn.units import UnitProblemError, convert, parse


def _pipe(tmp_path: Path) -> Path:
    path = tmp_path / "pipe.csv"
    os.mkfifo(path)
    return path


def _with_map(path: Path) -> str:
    table = f'[gears.pinion.modification]\nprofile_map = "{path}"\n'
    return SOUND.replace("[lubricant]", f"{table}[lubricant]")


@pytest.mark.parametrize("path", ["/dev/zero", "pipe"])
def test_special_files_are_refused_at_once(tmp_path: Path, path: str) -> None:
    special = _pipe(tmp_path) if path == "pipe" else Path(path)
    with pytest.raises(InputError, match="not a regular file"):
        load_case(special)
    with pytest.raises(InputError, match="not a regular file"):
        read_case(_with_map(special), str(tmp_path / "case.toml"))
    with pytest.raises(InputError, match="not a regular file"):
        read_table_file(special)


def test_a_file_too_large_for_a_case(tmp_path: Path) -> None:
    path = tmp_path / "case.toml"
    path.write_text(SOUND + "# " + "x" * 10**6)
    with pytest.raises(InputError, match="larger than 1 MB"):
        load_case(path)


def test_errors_show_no_content_of_foreign_files(tmp_path: Path) -> None:
    secret = tmp_path / "secret.txt"
    secret.write_text("root:x:0:0:topsecret\nuser,topsecret\nthree:topsecret\nfour\n")
    for work in (
        lambda: read_case(_with_map(secret), str(tmp_path / "case.toml")),
        lambda: read_table_file(secret),
    ):
        with pytest.raises(InputError) as caught:
            work()
        assert "topsecret" not in str(caught.value)


def test_a_profile_map_far_from_a_grid_is_refused_at_once(tmp_path: Path) -> None:
    path = tmp_path / "map.csv"
    head = "roll_length,face_position,deviation\nmm,mm,um\n"
    path.write_text(head + "".join(f"{row},{row},0.1\n" for row in range(100_000)))
    with pytest.raises(InputError, match="make no full grid"):
        read_case(_with_map(path), str(tmp_path / "case.toml"))


@pytest.mark.parametrize(
    "text",
    ["4.5 m^9^9^9", "4.5 m^99", "1 km^400", "10 rpm²1**3", "4.5 mm # x", "4.5 mm\0", "٤.٥ mm",
     "４.5 mm", "4.5 a" + " " * 16000 + "b", "4.5 (((((((m)))))))", "1e308 km^9", "4.5 mm;"],
)  # fmt: skip
def test_units_that_are_refused(text: str) -> None:
    with pytest.raises(UnitProblemError):
        parse(text, "m")
    with pytest.raises(UnitProblemError):
        convert(1.0, text.partition(" ")[2] + "^9^9^9", "m")


def test_units_still_have_their_spellings() -> None:
    for text, unit, value in [
        ("3 N/(mm µm)", "N/m^2", 3e9), ("5 kg mm²", "kg*m^2", 5e-6), ("1 GPa⁻¹", "1/Pa", 1e-9),
        ("5 m^(-1) m^2", "m", 5.0), ("12 in", "m", 0.3048), ("8 J/(kg K)", "J/(kg*K)", 8.0),
        ("104 °F", "K", 313.15), ("2 m**3 m**-2", "m", 2.0),
    ]:  # fmt: skip
        assert parse(text, unit) == pytest.approx(value, rel=1e-12)


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("teeth = " + "9" * 4301, "too long to be read"),
        ("teeth = 1" + "0" * 400, "digits"),
        ("teeth = 0x" + "f" * 4000, "digits"),
        ("teeth = " + "[" * 400 + "]" * 400, "nested too deeply"),
        ("teeth = " + "[" * 5000 + "]" * 5000, "nested too deeply"),
        ("a" + ".a" * 1000 + " = 1", "more parts"),
        ('roughness = "' + "x" * 5000 + '"', "unknown key"),
        ('x = "\\u0000"', "U\\+0000"),
        ('x = "\\u001b[2J"', "U\\+001B"),
        ('"\\u001b[2J" = 1', "U\\+001B"),
    ],
)
def test_values_that_no_case_holds(line: str, says: str) -> None:
    with pytest.raises(InputError, match=says) as caught:
        read_case(SOUND.replace("teeth = 16", line), "my.toml")
    text = str(caught.value)
    assert "my.toml" in text
    assert len(max(text.split(), key=len)) <= 210
    assert text.isprintable() or "\n" in text


def test_from_python_too() -> None:
    case = read_case(SOUND, "my.toml")
    for title in ("a\0b", "\ud800", "\x1b[2J", "x" * 20_000):
        with pytest.raises(InputError):
            case.replace({"title": title})
    for teeth in (10**400, 16.5, float("nan"), [[16]] * 3):
        with pytest.raises(InputError):
            case.replace({"gears.pinion.teeth": teeth})
    with pytest.raises(InputError, match="too large"):
        case.replace({"friction.coefficient": 10**400})


def test_the_number_of_listed_errors_is_limited() -> None:
    keys = "\n".join(f"key_{number} = 1" for number in range(2000))
    with pytest.raises(InputError) as caught:
        read_case(f"{keys}\n{SOUND}", "my.toml")
    assert len(caught.value.problems) <= 51
    error = TribodynError([Problem(f"fault {number}") for number in range(80)])
    assert str(error.problems[-1]).startswith("30 more problems")


def test_a_message_repeats_little_and_no_control_characters() -> None:
    problem = Problem(f'x = "{"y" * 900}"', "a\x1b[2Jb\u202e", "z" * 9000, "\ud800")
    assert "y" * 201 not in str(problem)
    assert "z" * 201 not in str(problem)
    assert str(problem).isprintable()
    assert "\\x1b[2J" in problem.where


@pytest.mark.parametrize("name", ["", "x" * 5000, "a\0b"])
def test_a_name_that_is_no_file(name: str) -> None:
    with pytest.raises(InputError):
        load_case(name)


_FULL = """
import errno, sys
from pathlib import Path
def full(*_, **__):
    raise OSError(errno.ENOSPC, "no space left on device")
Path.write_text = full
from tribodyn.cli import main
main(sys.argv[1:])
"""


def test_a_full_disk_is_reported_as_json_with_the_path(tmp_path: Path) -> None:
    import json

    arguments = ["new", "my.toml", "--from", "fzg-roughness", "--json"]
    done = subprocess.run(
        [sys.executable, "-c", _FULL, *arguments], cwd=tmp_path, capture_output=True, text=True
    )
    error = json.loads(done.stdout)["error"]
    assert done.returncode == error["exit_code"] == 1
    assert error["problems"][0]["where"] == "my.toml"
    assert "no space left" in error["problems"][0]["what"]
    assert os.listdir(tmp_path) == []


class _Meanwhile:
    """Progress during which something else happens, once."""

    def __init__(self, event: Callable[[], object]) -> None:
        self.events = [event]

    def start(self, task: str, total: int | None = None) -> None:
        while self.events:
            self.events.pop()()

    def advance(self, steps: int = 1) -> None:
        pass

    def finish(self) -> None:
        pass


def _profile(path: Path, height: float) -> None:
    place = np.arange(0.0, 4.0, 0.002)
    waves = height * (np.sin(90.0 * place) + np.sin(211.0 * place))
    rows = "".join(f"{x:.3f},{z:.4f}\n" for x, z in zip(place, waves, strict=True))
    path.write_text(f"position,height\nmm,um\n{rows}", encoding="utf-8")


@pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")
def test_a_file_that_changes_while_its_case_is_computed(tmp_path: Path) -> None:
    path = tmp_path / "flank.csv"
    _profile(path, 0.5)
    mixed = {"friction.law": "mixed", "friction.roughness_profile": str(path)}
    case = load_case("fzg-roughness").replace({"stiffness.model": "iso6336", **mixed})
    assert run(case).case == case
    with pytest.raises(InputError, match=r"flank\.csv changed while .* Run it again") as caught:
        run(case, _Meanwhile(lambda: _profile(path, 0.6)))
    assert [problem.where for problem in caught.value.problems] == ["friction.roughness_profile"]
    with pytest.raises(InputError, match=r"roughness_profile: .* there is no such file") as caught:
        run(case, _Meanwhile(path.unlink))
    assert len(caught.value.problems) == 1
