"""What a study has finished outlasts a kill, and only the same study takes it."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

from tribodyn.checkpoints import NAME, Checkpoints
from tribodyn.errors import InputError
from tribodyn.files import clear_leftovers

_STUDY = {"study": "sweep", "version": "1", "case": "a", "over": "b", "options": {"x": [1, 2.5]}}


def test_members_come_back_to_the_last_bit(tmp_path: Path) -> None:
    value = [np.array([0.1, np.nan, -np.inf]), np.int64(3), np.float64(1e-308), "µ", None, True]
    first = Checkpoints(tmp_path / "s").begin(_STUDY)
    first.keep("0", value)
    first.close()
    with Checkpoints(tmp_path / "s").begin(_STUDY) as again:
        assert len(again) == 1
        back = again.get("0")
        np.testing.assert_array_equal(back[0], value[0])
        assert back[1:] == [3, 1e-308, "µ", None, True]
        assert again.get("1") is None
        again.discard()
    assert os.listdir(tmp_path) == []


def test_a_torn_line_is_dropped_and_written_over(tmp_path: Path) -> None:
    first = Checkpoints(tmp_path / "s").begin(_STUDY)
    first.keep("0", 1.0)
    first.keep("1", 2.0)
    first.close()
    path = tmp_path / ".s.members" / NAME
    content = path.read_bytes()
    for end in range(len(content)):
        path.write_bytes(content[:end])
        members = Checkpoints(tmp_path / "s").begin(_STUDY)
        lines = content[:end].count(b"\n")
        assert len(members) == max(lines - 1, 0)
        members.close()
    path.write_bytes(content[:-3] + b"x" + content[-2:])
    members = Checkpoints(tmp_path / "s").begin(_STUDY)
    assert members.get("0") == 1.0
    assert members.get("1") is None
    members.keep("1", 3.0)
    members.close()
    assert Checkpoints(tmp_path / "s").begin(_STUDY).get("1") == 3.0


@pytest.mark.parametrize("part", [*_STUDY])
def test_another_study_is_refused_or_begun_anew(tmp_path: Path, part: str) -> None:
    first = Checkpoints(tmp_path / "s").begin(_STUDY)
    first.keep("0", 1.0)
    first.close()
    other = {**_STUDY, part: "other"}
    with pytest.raises(InputError, match=r"another unfinished study.*--force"):
        Checkpoints(tmp_path / "s").begin(other)
    with Checkpoints(tmp_path / "s", anew=True).begin(_STUDY) as same:
        assert same.get("0") == 1.0
    with Checkpoints(tmp_path / "s", anew=True).begin(other) as anew:
        assert len(anew) == 0


def test_a_living_process_has_the_place_alone(tmp_path: Path) -> None:
    with Checkpoints(tmp_path / "s").begin(_STUDY):
        with pytest.raises(InputError, match="directory is in use"):
            Checkpoints(tmp_path / "s", anew=True).begin(_STUDY)
        clear_leftovers(tmp_path / "s")
        assert (tmp_path / ".s.members").is_dir()


def test_members_of_a_saved_study_are_cleared_unless_it_was_interrupted(tmp_path: Path) -> None:
    for complete in (False, True):
        members = Checkpoints(tmp_path / "s").begin(_STUDY)
        (tmp_path / "s").mkdir(exist_ok=True)
        later = (tmp_path / ".s.members" / NAME).stat().st_mtime_ns + 1000
        os.utime(tmp_path / "s", ns=(later, later))
        if not complete:
            members.close_after(complete=False)
            assert (tmp_path / ".s.members" / NAME).stat().st_mtime_ns > later
        members.close()  # Killed before it could discard them, where the study is complete.
        clear_leftovers(tmp_path / "s")
        assert (tmp_path / ".s.members").exists() is not complete


def test_nothing_is_stored_without_a_folder() -> None:
    members = Checkpoints().begin(_STUDY)
    members.keep("0", 1.0)
    assert members.get("0") is None
    members.discard()
