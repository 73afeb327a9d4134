"""Files and directories appear whole or not at all."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from tribodyn.errors import InputError, OutputExistsError
from tribodyn.study.pipeline.save import new_directory, write_file


def _fill(place: Path, text: str = "{}") -> None:
    (place / "summary.json").write_text(text)


def test_directory_appears_only_when_complete(tmp_path: Path) -> None:
    target = tmp_path / "result"
    with new_directory(target) as place:
        _fill(place)
        assert not target.exists()
        assert place.parent == tmp_path
    assert os.listdir(tmp_path) == ["result"]
    assert os.listdir(target) == ["summary.json"]


@pytest.mark.parametrize("failure", [KeyboardInterrupt, RuntimeError, OSError])
def test_nothing_remains_of_a_failure(tmp_path: Path, failure: type[BaseException]) -> None:
    def fail() -> None:
        with new_directory(tmp_path / "result") as place:
            _fill(place)
            raise failure

    with pytest.raises(failure):
        fail()
    assert os.listdir(tmp_path) == []


def test_existing_result_is_not_replaced_without_force(tmp_path: Path) -> None:
    target = tmp_path / "result"
    target.mkdir()
    _fill(target, "old")
    with pytest.raises(OutputExistsError, match="force=True"), new_directory(target):
        pass
    with new_directory(target, force=True) as place:
        _fill(place, "new")
        assert (target / "summary.json").read_text() == "old"
    assert (target / "summary.json").read_text() == "new"
    assert os.listdir(tmp_path) == ["result"]


def test_a_failed_replacement_preserves_the_old_result(tmp_path: Path) -> None:
    target = tmp_path / "result"
    target.mkdir()
    _fill(target, "old")

    def fail() -> None:
        with new_directory(target, force=True):
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        fail()
    assert (target / "summary.json").read_text() == "old"
    assert os.listdir(tmp_path) == ["result"]


def test_force_never_replaces_other_files(tmp_path: Path) -> None:
    other = tmp_path / "photos"
    other.mkdir()
    (other / "holiday.jpg").write_text("x")
    file = tmp_path / "file"
    file.write_text("x")
    link = tmp_path / "link"
    link.symlink_to(other)
    for target, why in (
        (other, "holiday.jpg"),
        (file, "a file is in the way"),
        (link, "not a dir"),
    ):
        with pytest.raises(OutputExistsError, match=why), new_directory(target, force=True):
            pass
    assert (other / "holiday.jpg").exists()


def test_missing_parent(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no such directory"), new_directory(tmp_path / "a/b"):
        pass


def test_file_is_replaced_at_once(tmp_path: Path) -> None:
    file = tmp_path / "case.toml"
    write_file(file, "one")
    write_file(file, "µ two")
    assert file.read_text(encoding="utf-8") == "µ two"
    assert os.listdir(tmp_path) == ["case.toml"]
    with pytest.raises(InputError, match="cannot write"):
        write_file(tmp_path / "no" / "case.toml", "x")
