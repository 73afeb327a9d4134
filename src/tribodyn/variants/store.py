"""The store of a study: a manifest, and one netCDF file for each chunk of its members.

The manifest ``members.jsonl`` has one line for each record, preceded by a checksum: the identity of
the study, its members (again when it grows), and every complete chunk on the disk. A chunk is
written to a temporary file and moved; its line follows. After a process was killed at any moment,
the next one computes the chunks without a line.
"""

from __future__ import annotations

import json
import os
import re
import time
import zlib
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tribodyn.checkpoints import NAME, Checkpoints, read_lines
from tribodyn.errors import Argument, InputError, OutputExistsError, quiet
from tribodyn.files import atomic_write, lock
from tribodyn.study.studies.runner import identity
from tribodyn.validated_files import read_bytes
from tribodyn.variants.compute import Job, Stored
from tribodyn.variants.members import Chunk, Plan, layout_of

if TYPE_CHECKING:
    from tribodyn.variants.study_file import Study

#: Chunks of one folder, reported reasons, and chunks from which the remaining time is estimated.
_FOLDER, _REASONS, _RECENT = 1000, 20, 50


@dataclass(frozen=True)
class StudyState:
    """Progress of a study.

    Parameters
    ----------
    title : str
        Title of the study.
    members, done, failed : int
        Number of members, of those that are stored, and of those among them that failed.
    reasons : dict of str to int
        Reasons of failures with the number of members, the most frequent first.
    running : bool
        Whether a process of this machine computes it.
    seconds_left : float or None
        Estimate from the latest chunks [s]; None without an estimate.
    damaged : tuple of str
        Chunks that were damaged and have been computed again.
    missing : dict of str to str
        Chunks that could not be computed this time, and the reasons.
    """

    title: str
    members: int
    done: int
    failed: int
    reasons: Mapping[str, int]
    running: bool = False
    seconds_left: float | None = None
    damaged: tuple[str, ...] = ()
    missing: Mapping[str, str] = field(default_factory=dict)

    @property
    def complete(self) -> bool:
        """Whether every member is stored."""
        return self.done == self.members


def chunk_path(folder: Path, name: str) -> Path:
    """File of a chunk."""
    stage, number = name.split("/")
    return folder / f"{stage}-{int(number) // _FOLDER:03d}" / f"{int(number):06d}.nc"


def read_chunk(folder: Path, name: str, facts: Mapping[str, object]) -> bytes | None:
    """Content of a chunk; None if it is missing or does not match its checksum."""
    with suppress(OSError):
        content = read_bytes(chunk_path(folder, name), "netcdf")
        if zlib.crc32(content) == facts["crc"]:
            return content
    return None


_GIVE = "Give the directory that tribodyn study wrote"


class Manifest:
    """Read-only view of a store."""

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.folder = Path(path)
        try:
            lines, _ = read_lines(self.folder / NAME)
        except OSError as error:
            what = f"{path} cannot be read: {error.strerror}"
            raise InputError(what, Argument("path")) from None
        self.lines = lines[1:]
        values = {line["name"]: line["value"] for line in self.lines}
        if not str(lines[0].get("study", "") if lines else "").startswith("study ") or (
            "stage 0" not in values
        ):
            what, why = f"{path} is not the store of a study", f"It has no {NAME} of a study"
            study_folder = Path(str(path).removesuffix(".toml") + "-study")  # that of a study file
            remedy = f'Did you mean "{study_folder}"?' if study_folder.is_dir() else _GIVE
            raise InputError(what, Argument("path"), why, remedy)
        self.kind = str(lines[0]["study"]).removeprefix("study ")
        self.facts: Mapping[str, Any] = values["facts"]
        self.stages = stages_in(values)
        self.plan = Plan(layout_of(self.stages[-1]), self.stages)
        planned = {chunk.name for chunk in self.plan.chunks}
        self.chunks = {name: value for name, value in values.items() if name in planned}

    def state(self) -> StudyState:
        """Progress of the study."""
        lock_handle = lock(self.folder)
        if lock_handle is not None and lock_handle >= 0:
            os.close(lock_handle)
        done = sum(facts["members"] for facts in self.chunks.values())
        left = self.plan.layout.count - done
        return StudyState(
            str(self.facts["title"]),
            self.plan.layout.count,
            done,
            *reasons(self.chunks.values()),
            running=lock_handle is None,
            seconds_left=self._seconds(left) if left and lock_handle is None else None,
        )

    def _seconds(self, left: int) -> float | None:
        last_start = max(n for n, line in enumerate(self.lines) if line["name"] == "begun")
        recent = [line["value"] for line in self.lines[last_start:]][-_RECENT:]
        count = sum(facts["members"] for facts in recent[1:])
        return left * float(recent[-1]["time"] - recent[0]["time"]) / count if count else None


def study_state(path: str | os.PathLike[str]) -> StudyState:
    """Report the progress of the study in a store, running or not.

    Parameters
    ----------
    path : str or path
        Directory that :func:`run_study` or ``tribodyn study`` wrote, or writes at the moment.

    Raises
    ------
    InputError
        If the directory is not a store.
    """
    return Manifest(path).state()


def stages_in(values: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    """Members of a study at each of its stages."""
    count = sum(name.startswith("stage ") for name in values)
    return [values[f"stage {number}"] for number in range(count)]


def reasons(chunks: Iterable[Mapping[str, Any]]) -> tuple[int, dict[str, int]]:
    """Number of failed members, and number by reason."""
    failed, counts = 0, dict[str, int]()
    for facts in chunks:
        failed += facts["failed"]
        for reason, count in facts["reasons"].items():
            counts[reason] = counts.get(reason, 0) + count
    return failed, dict(sorted(counts.items(), key=lambda item: -item[1])[:_REASONS])


class Store:
    """A store that this process writes exclusively."""

    def __init__(self, study: Study, folder: Path, force: bool = False) -> None:
        self.study, self.folder = study, folder
        _check_place(folder)
        self.members = Checkpoints(folder, force, inside=True)

    def __enter__(self) -> Store:
        """Lock the directory and read what is stored."""
        members, study = self.members.begin(self._identity()), self.study
        try:
            values = members.all()
            if "facts" not in values:
                facts: dict[str, Any] = {
                    "title": study.title,
                    "case": study.case.to_toml(),
                    "keep": study.keep,
                }
                members.keep("facts", facts)
            stages = stages_in(values)
            layout = study.layout.after(stages[-1], study.place) if stages else study.layout
            self.study = replace(study, layout=layout)
            facts = {**layout.facts(), "chunk": study.chunk}
            if not stages or {**stages[-1], "chunk": study.chunk} != _plain(facts):
                members.keep(f"stage {len(stages)}", facts)
                stages.append(_plain(facts))
            self.plan = Plan(layout, stages)
            self.chunks = {c.name: values[c.name] for c in self.plan.chunks if c.name in values}
            self.damaged = tuple(self._damaged())
            members.keep("begun", {"time": time.time(), "members": 0})
        except BaseException:
            members.close()
            raise
        return self

    def _identity(self) -> dict[str, Any]:
        """Identity of the study, independent of the number of its members."""
        study = self.study
        return identity(
            f"study {study.compute}", study.case, study.specification, keep=list(study.keep)
        )

    def job(self, chunk: Chunk) -> Job:
        """Input for the computation of a chunk."""
        study = self.study
        columns = study.layout.columns(self.plan.members(chunk))
        return Job(study.compute, study.case, study.keep, columns)

    def __exit__(self, *exception: object) -> None:
        """Release the directory for other processes."""
        self.members.__exit__(*exception)

    def _damaged(self) -> Iterator[str]:
        """Remove chunks that do not match their checksum, and yield their names."""
        for name, facts in list(self.chunks.items()):
            if read_chunk(self.folder, name, facts) is None:
                del self.chunks[name]
                yield name

    def left(self) -> list[Chunk]:
        """Chunks that still have to be computed."""
        return [chunk for chunk in self.plan.chunks if chunk.name not in self.chunks]

    def put(self, chunk: Chunk, result: Stored) -> None:
        """Write a chunk, then record it in the manifest."""
        path = chunk_path(self.folder, chunk.name)
        with quiet("leftover"):
            with suppress(OSError):  # atomic_write() reports the reason
                path.parent.mkdir(exist_ok=True)
            with atomic_write(path) as partial:
                partial.write_bytes(result.content)
        counts: dict[str, int] = {}
        for reason in filter(None, result.failed):
            counts[reason] = counts.get(reason, 0) + 1
        facts = {
            "members": len(result.failed),
            "failed": sum(counts.values()),
            "reasons": dict(sorted(counts.items(), key=lambda item: -item[1])[:_REASONS]),
            "figures": result.figures,
            "crc": zlib.crc32(result.content),
            "time": time.time(),
        }
        self.members.keep(chunk.name, facts)
        self.chunks[chunk.name] = facts

    def state(self, missing: Mapping[str, str]) -> StudyState:
        """Progress of the study."""
        state = Manifest(self.folder).state()
        return replace(
            state, running=False, seconds_left=None, damaged=self.damaged, missing=missing
        )


def _plain(facts: Mapping[str, object]) -> Any:
    """Facts as read back from the manifest."""
    return json.loads(json.dumps(facts))


def _check_place(folder: Path) -> None:
    """Refuse a directory with other content, which must not be touched."""
    own_names = re.compile(rf"{re.escape(NAME)}|\d+-\d{{3,}}")
    if folder.is_dir():
        strange = next((e.name for e in folder.iterdir() if not own_names.fullmatch(e.name)), "")
        reason = f"It is not the store of a study: it contains {strange}" if strange else ""
    else:
        reason = "It is not a directory" if folder.exists() or folder.is_symlink() else ""
    if reason:
        raise OutputExistsError("this exists already", str(folder), reason, "Choose another")
