"""The folder that the page was started in: it reads and writes there, and nowhere else."""

from __future__ import annotations

import re
import shutil
from pathlib import Path
from typing import TYPE_CHECKING

from tribodyn.errors import InputError, OutputExistsError
from tribodyn.study.case.read import parse_toml, read_text
from tribodyn.study.machine.housing_files import copy_housing
from tribodyn.study.machine.read import files_of, read_case

if TYPE_CHECKING:
    from tribodyn.study.machine.case import AnyCase

#: Characters of a name, case files that are listed, and how deep the search goes.
_LONGEST, _LISTED, _DEEP = 120, 200, 3
#: One part of a name: nothing hidden, no drive, no stream, nothing that shells or browsers read.
_PART = re.compile(r"[^\W_][\w .+,()=@-]*", re.UNICODE)


class Workspace:
    """Folder of the page, with checked access to its files."""

    def __init__(self, root: Path) -> None:
        self.root = root.resolve()

    def inside(self, name: str, suffix: str = "") -> Path:
        """Path of a name such as ``gears/my.toml``; raise if it is outside the folder."""
        text = name.strip()
        if suffix and text and not text.endswith(suffix):
            text += suffix
        parts = text.split("/")
        plain = all(_PART.fullmatch(p) and not p.endswith((".", " ")) for p in parts)
        if not plain or len(text) > _LONGEST:
            why = "It is letters, digits, spaces, points and dashes, folders parted by /"
            raise InputError(f'"{name}" is no name of a file here', "", why, "Write my-gears")
        place = (self.root / text).resolve()
        if not place.is_relative_to(self.root) or place == self.root:
            raise self._outside(name)
        return place

    def _outside(self, name: str) -> InputError:
        why = f"The page was started in {self.root.name} and stays there"
        return InputError(f'"{name}" lies outside of the folder', "", why, "Copy it there")

    def relative_name(self, place: Path | str) -> str:
        """Path relative to the folder, as text."""
        return str(place).replace(f"{self.root}/", "")

    def cases(self) -> list[str]:
        """Case files in the folder, the nearest first."""
        names: list[str] = []
        levels = [self.root]
        for _ in range(_DEEP):
            inner: list[Path] = []
            for folder in levels:
                entries = sorted(folder.iterdir()) if folder.is_dir() else []
                inner += [e for e in entries if e.is_dir() and not e.is_symlink()]
                names += [
                    self.relative_name(e)
                    for e in entries
                    if e.suffix == ".toml" and self._is_accessible(e)
                ]
            levels = [folder for folder in inner if _PART.fullmatch(folder.name)]
            if len(names) >= _LISTED:
                break
        return names[:_LISTED]

    def _is_accessible(self, place: Path) -> bool:
        try:
            return self.inside(self.relative_name(place)).is_file()
        except InputError:
            return False

    def load(self, name: str) -> AnyCase:
        """Read a case file; files that it names have to be in the folder too."""
        place = self.inside(name, ".toml")
        if not place.is_file():
            raise InputError(f'there is no file "{name}"', "", "", "Choose one from the list")
        return self.read(read_text(place), place)

    def read(self, text: str, place: Path) -> AnyCase:
        """Read a case from text as a file of the folder."""
        name = self.relative_name(place)
        for named in files_of(parse_toml(text, name)):
            if not (place.parent / named).resolve().is_relative_to(self.root):
                raise self._outside(named)
        case: AnyCase = read_case(text, str(place))
        return case

    def save_case(self, case: AnyCase, name: str, force: bool = False) -> Path:
        """Write a case file with the files of a housing; replace one only with ``force``."""
        from tribodyn.study.pipeline.save import write_file

        place = self.inside(name, ".toml")
        if place.exists() and (place.is_dir() or not force):
            remedy = "Choose another name, or save once more to replace it"
            raise OutputExistsError(f'"{self.relative_name(place)}" exists already', "", "", remedy)
        self._parent(place)
        case = copy_housing(case, place.parent, f"{place.stem}-")
        write_file(place, case.to_toml())
        return place

    def save_result(self, directory: Path, name: str) -> Path:
        """Copy a directory of results to a new place."""
        from tribodyn.study.pipeline.save import new_directory

        place = self.inside(name)
        self._parent(place)
        with new_directory(place) as new:
            shutil.copytree(directory, new, dirs_exist_ok=True)
        return place

    def _parent(self, place: Path) -> None:
        if not place.parent.is_dir():
            parent_name = self.relative_name(place.parent)
            raise InputError(
                f'there is no folder "{parent_name}"', "", "", "Create it, or leave it out"
            )
