"""Labelled recordings over sizes of faults, loads and speeds: a data set for learning."""

from __future__ import annotations

import csv
import hashlib
import itertools
import json
import os
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.errors import InputError
from tribodyn.files import atomic_write
from tribodyn.nomenclature import require_whole
from tribodyn.progress import SILENT, Progress
from tribodyn.study.faults.machine_section import defects_of
from tribodyn.study.faults.motion import turning_motion
from tribodyn.study.faults.recording import Scatter, recording_of
from tribodyn.study.faults.sensors import check_sensors, sensors_of
from tribodyn.study.studies.runner import run_each
from tribodyn.study.studies.study_axes import Axis, read_axes
from tribodyn.types import ByName, Tree

if TYPE_CHECKING:
    from tribodyn.measurement import Recording
    from tribodyn.study.faults.turning import PeriodicMotion
    from tribodyn.study.machine.case import AnyCase

#: Files of a set: description, labels, and recordings of one variant.
CARD, LABELS, PART = "card.json", "labels.csv", "variant-{:05d}.h5"


@dataclass(frozen=True)
class RecordingSet:
    """Recordings in a folder, with their labels.

    Parameters
    ----------
    folder : Path
        Folder with ``card.json``, ``labels.csv`` and one HDF5 file for each variant.
    card : mapping
        What was computed: keys with their units and values, sensor, rate, noise.
    labels : tuple of mapping
        ``variant``, ``draw``, ``seed`` and the keys of each recording, in SI.
    """

    folder: Path
    card: ByName
    labels: tuple[ByName, ...]

    def __len__(self) -> int:
        """Number of recordings."""
        return len(self.labels)

    def __getitem__(self, number: int) -> Recording:
        """Read one recording."""
        import h5py

        from tribodyn.measurement import Recording

        label = self.labels[number]
        with h5py.File(self.folder / PART.format(label["variant"]), "r") as file:
            channels = {name: file[name][label["draw"]].astype(float) for name in file}
        return Recording(channels, self.card["sample_rate"], self.card["units"])

    def __iter__(self) -> Iterator[tuple[ByName, Recording]]:
        """Labels and recordings in order."""
        for number, label in enumerate(self.labels):
            yield label, self[number]

    def __repr__(self) -> str:
        """One line."""
        keys = ", ".join(self.card["keys"])
        return f"RecordingSet({len(self)} recordings of {self.card['duration']:g} s over {keys})"


def record_set(
    case: AnyCase,
    folder: str | os.PathLike[str],
    over: ByName,
    *,
    sensor: str,
    duration: float,
    sample_rate: float = 25_600.0,
    repeats: int = 1,
    noise: float = 0.0,
    speed_fluctuation: float = 0.0,
    tacho_jitter: float = 0.0,
    seed: int = 0,
    progress: Progress = SILENT,
) -> RecordingSet:
    """Compute labelled recordings over keys of a case.

    Parameters
    ----------
    case : Case
        With ``[faults.NAME]``. Load cases besides ``[operation]`` are left out.
    folder : str or path
        Where they are stored. The same call goes on where an interrupted one ended.
    over : mapping
        Dotted keys with their values, as for :func:`tribodyn.sweep`; several make a grid.
    sensor : str
        As for ``Result.recording``, and so are the others.
    duration : float
        Length of a recording [s].
    sample_rate : float
        Samples per second [Hz].
    repeats : int
        Recordings of each variant, which differ in what scatters.
    noise : float
        Standard deviation of white noise, in the unit of the sensor.
    speed_fluctuation, tacho_jitter : float
        Standard deviations relative to the speed and to a turn [1].
    seed : int
        Number of the draw of all that scatters.
    progress : Progress
        Receives the number of finished variants.

    Returns
    -------
    RecordingSet

    Raises
    ------
    InputError
        If a key or a value is not accepted, or the folder holds another set.

    Examples
    --------
    >>> import tribodyn
    >>> case = tribodyn.load_case("fzg-roughness").replace({
    ...     "faults.crack.kind": "crack", "faults.crack.gear": "pinion",
    ...     "faults.crack.tooth": 1, "faults.crack.depth": "1 mm"})
    >>> sizes = {"faults.crack.depth": ["0 mm", "1 mm", "2 mm"]}
    >>> record_set(case, "cracks", sizes, sensor="acceleration_loa_pinion",
    ...            duration=1.0, repeats=100, noise=2.0)  # doctest: +SKIP
    RecordingSet(300 recordings of 1 s over faults.crack.depth)
    """
    repeats = require_whole("repeats", repeats, 1)
    seed = require_whole("seed", seed, 0)
    axes = read_axes(case, over)
    points = list(itertools.product(*(axis.values for axis in axes)))
    scatter = {
        "noise": noise,
        "speed_fluctuation": speed_fluctuation,
        "tacho_jitter": tacho_jitter,
        "seed": seed,
    }
    sampling = {"sensor": sensor, "duration": duration, "sample_rate": sample_rate}
    card = _card(case, axes, {**sampling, **scatter, "repeats": repeats})
    place = _opened(Path(folder), card)

    def written(number: int) -> Mapping[str, str]:
        part = place / PART.format(number)
        if part.is_file():
            return {}
        values = dict(zip((axis.key for axis in axes), points[number], strict=True))
        draws = [
            Scatter(noise, speed_fluctuation, tacho_jitter, _seed(seed, number, draw))
            for draw in range(repeats)
        ]
        return _write(part, case.replace(values), sampling, draws)

    try:
        units = run_each(written, range(len(points)), task="Recordings", progress=progress)
    except InputError:
        _abandon(place)
        raise
    return _finished(place, card, axes, points, next(filter(None, units), {}))


def _card(case: AnyCase, axes: tuple[Axis, ...], settings: Tree) -> Tree:
    """Description of a set, with a digest of everything that it depends on."""
    from tribodyn import __version__

    keys = {axis.key: {"unit": axis.unit, "values": list(axis.values)} for axis in axes}
    card = {"title": case.title, "tribodyn": __version__, "keys": keys, **settings}
    content = json.dumps(card, sort_keys=True) + case._text(comments=True)
    return {**card, "digest": hashlib.sha256(content.encode()).hexdigest()}


def _opened(folder: Path, card: Tree) -> Path:
    """Make the folder, or check that it holds the same set."""
    file = folder / CARD
    if file.is_file():
        stored = json.loads(file.read_text(encoding="utf-8"))
        if stored.get("digest") != card["digest"]:
            what = f"{folder} holds another set of recordings"
            why = f'It is of "{stored.get("title")}" over {", ".join(stored.get("keys", {}))}'
            raise InputError(what, "argument folder", why, "Give another folder")
        return folder
    if folder.exists() and any(folder.iterdir()):
        why = "A set of recordings has a folder of its own"
        raise InputError(f"{folder} is not empty", "argument folder", why, "Give another folder")
    folder.mkdir(parents=True, exist_ok=True)
    _store(folder, card)
    return folder


def _abandon(folder: Path) -> None:
    """Remove a set without any recording, so that the corrected call finds an empty place."""
    if [file.name for file in folder.iterdir()] == [CARD]:
        (folder / CARD).unlink()
        folder.rmdir()


def _store(folder: Path, card: ByName) -> None:
    with atomic_write(folder / CARD) as part:
        part.write_text(json.dumps(card, indent=2, allow_nan=False) + "\n", encoding="utf-8")


def _seed(seed: int, variant: int, draw: int) -> int:
    """A number for each recording that no other has."""
    text = f"{seed} {variant} {draw}".encode()
    return int.from_bytes(hashlib.sha256(text).digest()[:4], "big") % 10**9


def _recorder(case: AnyCase, sensor: str) -> Callable[[float, float, Scatter], Recording]:
    """Function of duration, rate and scatter that samples the motion of a case."""
    from tribodyn.study.machine.run import run_machine
    from tribodyn.study.pipeline.run import prepare_run

    check_sensors(sensors_of(case), sensor)
    motion: PeriodicMotion
    if not case.lumped:
        motion = run_machine(case.replace({"load_cases": None})).turning_motion
    else:
        motion = turning_motion(prepare_run(case))
    return partial(recording_of, motion, defects_of(case), sensor)


def _write(part: Path, case: AnyCase, sampling: ByName, draws: list[Scatter]) -> Mapping[str, str]:
    """Compute the motion of one variant and write all its recordings; return their units."""
    import h5py

    from tribodyn.errors import collected

    with collected():
        record = _recorder(case, sampling["sensor"])
        span = sampling["duration"], sampling["sample_rate"]
        recordings = [record(*span, draw) for draw in draws]
    with atomic_write(part) as file, h5py.File(file, "w") as store:
        for name, unit in recordings[0].units.items():
            rows = np.stack([recording[name] for recording in recordings]).astype(np.float32)
            store.create_dataset(name, data=rows).attrs["units"] = unit
    return recordings[0].units


def _finished(
    folder: Path,
    card: Tree,
    axes: tuple[Axis, ...],
    points: list[tuple[Any, ...]],
    units: Mapping[str, str],
) -> RecordingSet:
    """Write the labels, and the units into the description."""
    labels = tuple(
        {
            "variant": number,
            "draw": draw,
            "seed": _seed(card["seed"], number, draw),
            **dict(zip((axis.key for axis in axes), point, strict=True)),
        }
        for number, point in enumerate(points)
        for draw in range(card["repeats"])
    )
    if not units:
        units = json.loads((folder / CARD).read_text(encoding="utf-8")).get("units", {})
    stored = {**card, "units": dict(units), "recordings": len(labels)}
    _store(folder, stored)
    with (
        atomic_write(folder / LABELS) as part,
        part.open("w", encoding="utf-8", newline="") as file,
    ):
        writer = csv.DictWriter(file, list(labels[0]))
        writer.writeheader()
        writer.writerows(labels)
    return RecordingSet(folder, stored, labels)
