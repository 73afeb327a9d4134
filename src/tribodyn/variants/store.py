"""The store of a study: a manifest, one netCDF file for each chunk, and one lazy data set of all.

The manifest ``members.jsonl`` has one line for each record, preceded by a checksum: the identity of
the study, its members (again when it grows), and every complete chunk on the disk. A chunk is
written to a temporary file and moved; its line follows. After a process was killed at any moment,
the next one computes the chunks without a line. Values are read on demand, against their checksum.
"""

from __future__ import annotations

import io
import json
import os
import re
import time
import zlib
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace
from math import prod
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.checkpoints import NAME, Checkpoints, read_lines
from tribodyn.errors import Argument, InputError, OutputExistsError, quiet
from tribodyn.files import atomic_write, lock
from tribodyn.interrupt import deferred
from tribodyn.study.pipeline.summary_figures import in_order
from tribodyn.study.studies.runner import identity
from tribodyn.types import ByName, Tree
from tribodyn.validated_files import read_bytes
from tribodyn.variants.compute import KINDS, Chunk, Grid, Job, Plan, Stored, layout_of

if TYPE_CHECKING:
    import xarray

    from tribodyn.variants.study_file import Study

#: Reason of a member that is not stored yet.
_NOT_YET = "not computed yet"


def open_study(path: str | os.PathLike[str]) -> xarray.Dataset:
    """Open the store of a study as one data set, finished or not.

    Parameters
    ----------
    path : str or path
        Directory that :func:`run_study` or ``tribodyn study`` wrote, or writes at the moment.

    Returns
    -------
    xarray.Dataset
        Figures in SI over the keys of a grid, or over ``member`` with the keys as coordinates, and
        ``failed``, the reason why a member has none. Values are read on demand.

    Raises
    ------
    InputError
        If the directory is not a store; later, if a requested chunk is damaged.
    """
    import xarray

    manifest = Manifest(path)
    layout = manifest.plan.layout
    coords: Tree = {}
    if isinstance(layout, Grid):
        dims = {axis.key: len(axis.values) for axis in layout.axes}
        for axis in layout.axes:
            values = np.array(axis.values)
            values = values.astype(object) if values.dtype.kind == "U" else values
            coords[axis.key] = (axis.key, values, {"units": axis.unit or "1"})
    else:
        dims = {"member": layout.count}
    names = (name for facts in manifest.chunks.values() for name in facts["figures"])
    kind = KINDS[manifest.kind]

    def lazy(name: str, kind: object, **facts: str) -> Any:
        return (tuple(dims), _lazy(manifest, name, tuple(dims.values()), kind), facts)

    variables = {
        name: lazy(name, float, units=unit, long_name=meaning)
        for name in in_order(names, kind.figures)
        for unit, meaning in (kind.figure(name),)
    }
    variables |= {name: lazy(name, object) for name in ("failed", "warnings")}
    if not isinstance(layout, Grid):
        for key, unit in layout.units.items():
            coords[key] = lazy(key, np.dtype(layout.kinds[key]), units=unit or "1")
    facts = {**manifest.facts, "keep": ", ".join(manifest.facts["keep"])}
    return xarray.Dataset(variables, coords, facts)


def _lazy(manifest: Manifest, name: str, shape: tuple[int, ...], kind: Any) -> Any:
    """One variable that xarray reads on demand."""
    from xarray.backends import BackendArray
    from xarray.core import indexing

    class Stored(BackendArray):
        def __init__(self) -> None:
            self.shape, self.dtype = shape, np.dtype(kind)

        def __getitem__(self, key: Any) -> Any:
            outer = indexing.IndexingSupport.OUTER
            return indexing.explicit_indexing_adapter(key, shape, outer, self.read)

        def read(self, key: tuple[Any, ...]) -> Any:
            places = [np.arange(size)[each] for size, each in zip(shape, key, strict=True)]
            result_shape = tuple(place.size for place in places if place.ndim)
            grid = np.ix_(*(np.atleast_1d(place) for place in places))
            members = np.ravel_multi_index(grid, shape).ravel()
            values = np.full(prod(result_shape), _absent(name, self.dtype), dtype=self.dtype)
            for chunk, where, rows in manifest.plan.locate(members):
                if chunk.name in manifest.chunks:
                    column = _column(manifest, chunk.name, name)
                    if column is not None:
                        values[where] = column[rows]
            return values.reshape(result_shape)

    return indexing.LazilyIndexedArray(Stored())


def _absent(name: str, dtype: np.dtype[Any]) -> Any:
    """Value of members that are not stored."""
    if dtype.kind == "f":
        return np.nan
    return {"failed": _NOT_YET}.get(name, "" if dtype.kind == "O" else 0)


@deferred()
def _column(manifest: Manifest, chunk: str, name: str) -> Any:
    """One variable of a chunk; None if there is none of that name."""
    import h5py

    content = read_chunk(manifest.folder, chunk, manifest.chunks[chunk])
    if content is None:
        what = f"{chunk_path(manifest.folder, chunk)} does not match its checksum"
        why = "It was damaged, changed or removed"
        remedy = "Run the study again, which computes it again"
        raise InputError(what, Argument("path"), why, remedy)
    with h5py.File(io.BytesIO(content)) as file:
        if name in file:
            column = file[name]
            return column.asstr()[()] if h5py.check_string_dtype(column.dtype) else column[()]
        figures = manifest.chunks[chunk]["figures"]
        return file["value"][:, figures.index(name)] if name in figures else None


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
        self.facts: ByName = values["facts"]
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


def stages_in(values: ByName) -> list[ByName]:
    """Members of a study at each of its stages."""
    count = sum(name.startswith("stage ") for name in values)
    return [values[f"stage {number}"] for number in range(count)]


def reasons(chunks: Iterable[ByName]) -> tuple[int, dict[str, int]]:
    """Number of failed members, and number by reason."""
    failed, counts = 0, Counter[str]()
    for facts in chunks:
        failed += facts["failed"]
        counts.update(facts["reasons"])
    return failed, dict(counts.most_common(_REASONS))


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
                facts: Tree = {
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

    def _identity(self) -> Tree:
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
        counts = Counter(filter(None, result.failed))
        facts = {
            "members": len(result.failed),
            "failed": sum(counts.values()),
            "reasons": dict(counts.most_common(_REASONS)),
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
