"""Recordings as files of a measuring system: WAV, MAT, HDF5, netCDF, UFF 58 and CSV."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.errors import InputError
from tribodyn.files import atomic_write
from tribodyn.measurement.readers.binary import optional_library

if TYPE_CHECKING:
    from tribodyn.measurement.recording import Recording


def write(
    recording: Recording, path: str | os.PathLike[str], truth: Mapping[str, Any] | None = None
) -> Path:
    """Write a recording in the format of a file name, and its truth beside it as JSON."""
    place = Path(path)
    writer = check_ending(place)
    if not place.parent.is_dir():
        why, remedy = "A recording is written into a folder that exists", "Make the folder first"
        raise InputError(f"there is no folder {place.parent}", "argument path", why, remedy)
    with atomic_write(place) as part:
        named = part.with_name(f"{part.name}{place.suffix}")
        writer(recording, named)
        named.replace(part)
    if truth is not None:
        labels = {"sample_rate": recording.sample_rate, "units": dict(recording.units), **truth}
        with atomic_write(place.with_suffix(".json")) as part:
            part.write_text(json.dumps(labels, indent=2, allow_nan=False) + "\n", encoding="utf-8")
    return place


def check_ending(place: Path) -> Callable[[Recording, Path], None]:
    """Return the writer of a file name; raise InputError if there is none."""
    writer = _WRITERS.get(place.suffix.lower())
    if writer is None:
        what = f'"{place.name}" has no ending of a recording'
        why = f"Recordings are written as {', '.join(_WRITERS)}"
        raise InputError(what, "argument path", why, "Choose one of these endings")
    return writer


def _wav(recording: Recording, path: Path) -> None:
    from scipy.io import wavfile

    columns = np.stack([*recording.channels.values()], axis=1).astype(np.float32)
    wavfile.write(path, round(recording.sample_rate), columns)


def _mat(recording: Recording, path: Path) -> None:
    from scipy.io import savemat

    channels = {_identifier(name): values for name, values in recording.channels.items()}
    units = {f"{_identifier(name)}_unit": unit for name, unit in recording.units.items() if unit}
    names = {f"{_identifier(name)}_name": name for name in recording.channels}
    savemat(path, {"fs": recording.sample_rate, **channels, **units, **names}, oned_as="column")


def _identifier(name: str) -> str:
    """A name that MATLAB accepts."""
    plain = "".join(letter if letter.isalnum() else "_" for letter in name)
    return plain if plain[:1].isalpha() else f"x{plain}"


def _hdf5(recording: Recording, path: Path) -> None:
    import h5py

    with h5py.File(path, "w") as file:
        file.attrs["sample_rate"] = recording.sample_rate
        for name, values in recording.channels.items():
            dataset = file.create_dataset(name, data=values, compression="gzip", shuffle=True)
            dataset.attrs["units"] = recording.units[name]


def _uff(recording: Recording, path: Path) -> None:
    pyuff = optional_library("pyuff", path)
    for name, values in recording.channels.items():
        dataset = {
            "type": 58, "binary": 1, "func_type": 1, "rsp_node": 1, "rsp_dir": 1, "ref_node": 1,
            "ref_dir": 1, "data": values, "x": recording.time, "id1": name,
            "rsp_ent_name": name[:10], "ref_ent_name": "NONE", "abscissa_spacing": 1,
            "abscissa_inc": 1.0 / recording.sample_rate, "abscissa_spec_data_type": 17,
            "ordinate_spec_data_type": 0, "orddenom_spec_data_type": 0, "z_axis_spec_data_type": 0,
            "ordinate_axis_units_lab": recording.units[name] or "NONE", "n_bytes": 0,
            **dict.fromkeys(("id2", "id3", "id4", "id5"), "NONE"),
        }  # fmt: skip
        # the mode "overwrite" of pyuff loses the head of a binary dataset
        pyuff.UFF(str(path)).write_sets(dataset, mode="add")


def _csv(recording: Recording, path: Path) -> None:
    names = [f"{n} [{u}]" if u else n for n, u in recording.units.items()]
    columns = np.stack([recording.time, *recording.channels.values()], axis=1)
    np.savetxt(path, columns, "%.9g", ",", header=",".join(["time [s]", *names]), comments="")


_WRITERS: dict[str, Callable[[Recording, Path], None]] = {
    ".wav": _wav,
    ".mat": _mat,
    ".h5": _hdf5,
    ".uff": _uff,
    ".csv": _csv,
}
