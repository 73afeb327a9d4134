"""Wrong study files: each fault names its line and field, what is allowed and what to do."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from tribodyn.errors import InputError
from tribodyn.variants import load_study, read_study

_CASE = 'case = "fzg-roughness"\n'
_AXES = '[axes]\noperation.speed = "400..900 rpm:3"\n'
_DRAWN = "[samples]\nsize = 8\nseed = 1\n"

BROKEN = {
    "": "case: case is missing.*fzg-roughness.*nothing varies.*axes, samples, cases, table",
    'case = "fzg-roughnes"\n' + _AXES: 's.toml:1: case.*Did you mean "fzg-roughness"',
    _CASE + "chunks = 3\n" + _AXES: 's.toml:2.*unknown key.*Did you mean "chunk"',
    _CASE + "chunk = 0\n" + _AXES: r"s.toml:2: chunk: chunk = 0\. Allowed: 1 to 1000000",
    _CASE + 'compute = "motion"\n' + _AXES: "Allowed: summary, motions",
    _CASE + 'keep = ["rms_mesh_forc"]\n' + _AXES: 'Did you mean "rms_mesh_force"',
    _CASE + 'keep = ["loudness"]\n' + _AXES: "List the names by: tribodyn run CASE --json",
    _CASE + "keep = 5\n" + _AXES: "keep = 5. It is a list",
    _CASE + _AXES + _DRAWN: "axes and samples are set",
    _CASE + "axes = 5\n": "axes: 5. It is a table",
    _CASE + '[axes]\noperation.sped = "1..2 rpm:3"': 's.toml:3.*Did you mean "speed"',
    _CASE + '[axes]\noperation.speed = "1..2 rpm"': "number of points after a colon is missing",
    _CASE + '[axes]\noperation.speed = "-1..2 rpm:3"': "Allowed: 0.01 rpm to 200000 rpm",
    _CASE + "[axes]\noperation.speed = [1, 2]": 'needs a unit.*operation.speed = "400..3500 rpm',
    _CASE + "[axes]\noperation.speed = 3": "a range, or a list of values",
    _CASE + '[axes]\noperation = "1..2 rpm:3"': "operation is a table",
    _CASE + '[axes]\nfriction.law = ["no", "xu-2007"]': 'Did you mean "none"',
    _CASE + _AXES + '"operation.speed" = "4..9 rpm:3"': "operation.speed is set twice",
    _CASE + '[axes]\noperation.speed = "1..2 rpm:100000"\noperation.torque = "1..2 N*m:100000"': (
        r"1e\+10 members. The limit is 1e\+08"
    ),
    _CASE + '[axes]\nforce_scale = "1..2:3"': "force_scale.*unknown key",
    _CASE + 'compute = "motions"\n[axes]\nforce_scale = "2..1:3"': "A range rises",
    _CASE + _DRAWN: "samples.over: nothing varies",
    _CASE + "[samples]\nsize = 3.5\nsed = 1\n": "seed is missing.*whole number.*sed: unknown key",
    _CASE
    + _DRAWN
    + '[samples.over]\noperation.speed = "4 bar .. 5 bar"': "not a distribution.*rad/s",
    _CASE + _DRAWN + '[samples.over]\noperation.spee = "4 rpm .. 5 rpm"': 'Did you mean "speed"',
    _CASE + "cases = 5": "one table for each member",
    _CASE + '[[cases]]\noperation.speed = "4 rpm"\n[[cases]]\noperation.torque = "4 N*m"': (
        "member 2.*same keys"
    ),
    _CASE + '[[cases]]\noperation.speed = "4 bar"': "member 1.*rpm",
    _CASE + "[[cases]]\n" + "a." * 30 + "b = 1": "a: unknown key",
    _CASE + "x = " + "[" * 5000 + "]" * 5000: "too deeply",
    _CASE + 'title = "' + "a" * 20000 + '"\n' + _AXES: "at most 10000 characters",
    _CASE + '[axes]\noperation.speed = "' + "[" * 9000 + '"': "s.toml:3",
    _CASE + 'table = "/dev/zero"': "not a regular file",
    _CASE + 'table = "no.csv"': "there is no such file.*first line reads",
    'case = "/dev/zero"\n' + _AXES: "not a regular file",
    _CASE + "[set]\noperation.torque = 3\n" + _AXES: "s.toml:3: set.operation.torque.*unit",
}


@pytest.mark.parametrize("text", BROKEN, ids=range(len(BROKEN)))
def test_every_fault_is_reported(text: str) -> None:
    with pytest.raises(InputError) as caught:
        read_study(text, "s.toml")
    message = " ".join(map(str, caught.value.problems))
    assert re.search(BROKEN[text], message), message
    assert len(message) < 6000
    for problem in caught.value.problems:
        assert str(problem.where).startswith("s.toml")


@pytest.mark.parametrize(
    ("table", "message"),
    [
        ("", "has no members"),
        ("operation.speed [rpm]\n", "has no members"),
        ("operation.speed [rpm], operation.speed [rpm]\n1,2", "keys are missing or twice"),
        ("operation.speed [rpm], operation.torque [N*m]\n900, 90\n900", "t.csv:3: 1 values"),
        ("operation.speed [rpm]\n900\n9oo", r"t.csv:3: .*9oo"),
        ("operation.speed\n900\n", "needs a unit"),
        ("operation.sped [rpm]\n900\n", 'Did you mean "speed"'),
        ("operation.speed [rpm]\n\x00", "t.csv"),
    ],
)
def test_tables_are_read_with_care(tmp_path: Path, table: str, message: str) -> None:
    (tmp_path / "t.csv").write_text(table)
    (tmp_path / "s.toml").write_text(_CASE + 'table = "t.csv"')
    with pytest.raises(InputError, match=message):
        load_study(tmp_path / "s.toml")


def test_files_are_searched_in_the_folder_of_the_study(tmp_path: Path) -> None:
    from tribodyn import load_case

    (tmp_path / "my.toml").write_text(load_case("fzg-12dof").to_toml())
    (tmp_path / "t.csv").write_text("friction.law, operation.speed [rpm]\nnone, 60\nxu-2007,120\n")
    (tmp_path / "s.toml").write_text('case = "my.toml"\ntable = "t.csv"\ntitle = "Two"')
    study = load_study(tmp_path / "s.toml")
    assert study.title == "Two"
    assert study.case == load_case("fzg-12dof")
    columns = study.layout.columns(np.arange(2))
    assert columns["friction.law"] == ["none", "xu-2007"]
    np.testing.assert_allclose(columns["operation.speed"], [2.0 * np.pi, 4.0 * np.pi], rtol=1e-15)
