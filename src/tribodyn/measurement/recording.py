"""Recording of a test rig: sampled channels with their units, read, cut and written."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from types import MappingProxyType

import numpy as np

from tribodyn.errors import (
    Argument,
    InputError,
    Problem,
    did_you_mean,
    require_positive,
    shortened,
    warn,
)
from tribodyn.files import atomic_write
from tribodyn.measurement.readers.binary import optional_library
from tribodyn.measurement.readers.detect_format import read_recording_data
from tribodyn.measurement.readers.recording_data import (
    MEASURED,
    RecordingData,
    consistent_rate,
    rate_of,
)
from tribodyn.record import Parts, Record, fact, record
from tribodyn.signals.angular_resampling import checked_signal
from tribodyn.types import Array
from tribodyn.units import UnitProblemError, convert


def write(
    recording: Recording, path: str | os.PathLike[str], truth: Mapping[str, object] | None = None
) -> Path:
    """Write a recording in the format of a file name, and its truth next to it as JSON."""
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


#: Samples up to which channels start at the same time.
_SAME_START = 0.01
_SENSITIVITY = re.compile(r"\s*([0-9.eE+-]+)\s*([^/]+)/\s*(.+?)\s*")


@record
class Recording(Record):
    """Channels of a test rig, sampled simultaneously at one rate.

    Parameters
    ----------
    channels : mapping of str to (n,) array
        Samples of each channel by its name, in its unit.
    sample_rate : float
        Samples per second [Hz].
    units : mapping of str to str
        Unit of each channel; a channel that is missing has no unit.

    Raises
    ------
    InputError
        If there is no channel, a sample is not finite, or the channels differ in length.

    Examples
    --------
    >>> time = np.arange(2000) / 1000.0
    >>> recording = Recording({"acc": np.sin(2 * np.pi * 50.0 * time)}, 1000.0, {"acc": "m/s^2"})
    >>> recording
    Recording(acc [m/s^2], 2000 samples at 1000 Hz, 2 s)
    >>> recording.cut(0.5, 1.0)["acc"].size
    500
    """

    channels: Mapping[str, Array]
    sample_rate: float = fact()
    units: Mapping[str, str]

    def __post_init__(self) -> None:
        require_positive("sample_rate", self.sample_rate, "Hz")
        are_mappings = isinstance(self.channels, Mapping) and isinstance(self.units, Mapping)
        if (
            not are_mappings
            or not self.channels
            or not all(isinstance(n, str) for n in self.channels)
        ):
            what = f"channels = {shortened(repr(self.channels))}"
            why = "Expected a mapping of names to samples and one of names to units"
            remedy = 'Write Recording({"acc": samples}, 51200.0, {"acc": "m/s^2"})'
            raise InputError(what, Argument("channels"), why, remedy)
        samples = {n: checked_signal(v, 1, f"channel {n}") for n, v in self.channels.items()}
        sizes = {values.size for values in samples.values()}
        if len(sizes) > 1:
            sizes_by_channel = ", ".join(
                f"{name} {values.size}" for name, values in samples.items()
            )
            what = "the channels have different numbers of samples"
            why = f"Channels of one recording have equal length: {sizes_by_channel}"
            remedy = "Select channels of equal length, as with channels=[...] of read"
            raise InputError(what, Argument("channels"), why, remedy)
        units = {name: str(self.units.get(name, "")) for name in samples}
        object.__setattr__(self, "channels", MappingProxyType(samples))
        object.__setattr__(self, "units", MappingProxyType(units))
        object.__setattr__(self, "sample_rate", float(self.sample_rate))

    def __getitem__(self, name: str) -> Array:
        """Samples of one channel."""
        if name not in self.channels:
            raise _no_channel(name, self.channels)
        return self.channels[name]

    @property
    def time(self) -> Array:
        """Time of each sample after the first one [s]."""
        size = next(iter(self.channels.values())).size
        return np.arange(size) / self.sample_rate

    @property
    def duration(self) -> float:
        """Number of samples divided by the sampling rate [s]."""
        return float(next(iter(self.channels.values())).size / self.sample_rate)

    def cut(self, start: float, end: float) -> Recording:
        """Part of the recording between two times.

        Parameters
        ----------
        start, end : float
            Times from the first sample [s].

        Returns
        -------
        Recording
            Samples from the start up to, but excluding, the end.

        Raises
        ------
        InputError
            If the times are outside the recording or not in ascending order.
        """
        if not 0.0 <= start < end <= self.duration * (1.0 + 1e-12):
            why = f"The recording lasts {self.duration:g} s"
            remedy = "Pass two times within it, the earlier first"
            raise InputError(f"from {start:g} to {end:g} s", "arguments start and end", why, remedy)
        window = slice(*(int(np.ceil(at * self.sample_rate - 1e-9)) for at in (start, end)))
        parts = {name: values[window] for name, values in self.channels.items()}
        return Recording(parts, self.sample_rate, self.units)

    def save(
        self, path: str | os.PathLike[str], *, truth: Mapping[str, object] | None = None
    ) -> Path:
        """Write the recording as a measuring system would store it; :func:`read` reads it.

        Parameters
        ----------
        path : str or path
            File to write; its ending sets the format: ``.wav`` (32 bit floats in SI), ``.mat``,
            ``.h5``, ``.uff`` (dataset 58, needs ``pip install "tribodyn[io]"``), ``.csv``, or
            ``.nc`` with a checksum.
        truth : mapping, optional
            Labels, written next to it as JSON with the same name; not with ``.nc``.

        Returns
        -------
        Path
            The file.

        Raises
        ------
        InputError
            If the format or the folder is unknown.

        Examples
        --------
        >>> import tempfile
        >>> wave = Recording({"acc": np.zeros(64)}, 1000.0, {"acc": "m/s^2"})
        >>> file = wave.save(f"{tempfile.mkdtemp()}/wave.csv", truth={"fault": "none"})
        >>> read(file).units["acc"]
        'm/s^2'
        """
        if Path(path).suffix.lower() == ".nc" and truth is None:
            return Record.save(self, path)
        return write(self, path, truth)

    def __repr__(self) -> str:
        """Channels, size, rate and duration in one line."""
        names = [f"{name} [{unit}]" if unit else name for name, unit in self.units.items()]
        more = [*names[:6], f"{len(names) - 6} more"] if len(names) > 7 else names
        size = next(iter(self.channels.values())).size
        return (
            f"Recording({', '.join(more)}, {size} samples at {self.sample_rate:.6g} Hz, "
            f"{self.duration:.6g} s)"
        )

    def _parts(self) -> Parts:
        parts = super()._parts()
        parts.coordinates["time"] = ("time", self.time, {"units": "s"})
        for name, values in self.channels.items():
            parts.variables[name] = ("time", values, {"units": self.units[name]})
        return parts


def read(
    path: str | os.PathLike[str],
    *,
    channels: Iterable[str] | None = None,
    sample_rate: float | None = None,
    units: Mapping[str, str] | None = None,
    sensitivity: Mapping[str, str] | None = None,
) -> Recording:
    r"""Read a recording of a test rig: CSV, MAT, WAV, UFF 58, TDMS, HDF5 or netCDF.

    Parameters
    ----------
    path : str or path
        Path of the file. The format is detected from its content; text may be compressed (``.gz``).
    channels : iterable of str, optional
        Channels to read; all by default.
    sample_rate : float, optional
        Samples per second [Hz], if the file has neither a time column nor a rate. Pass 1 if it is
        not known: times are then in samples, frequencies in cycles per sample, and orders relative
        to a line remain right (``line`` of :func:`analyse_signal`).
    units : mapping of str to str, optional
        Units of channels, if the file has none or a wrong one.
    sensitivity : mapping of str to str, optional
        Sensitivity of the sensor of a channel that holds its voltage, such as ``"100 mV/g"``:
        the channel is converted to the SI unit of the measured quantity.

    Raises
    ------
    InputError
        If the file cannot be read, contradicts its suffix, is truncated, or has samples that are
        not finite, times that are not evenly spaced, or no sampling rate, or if its channels have
        no time in common.

    Warns
    -----
    ModelWarning
        ``channels-aligned`` where channels start at different times: they are shifted by whole
        samples and cut to the time that all of them have.

    Notes
    -----
    A CSV file may begin with header lines. Its columns are delimited by commas, semicolons, tabs
    or blanks; the decimal sign may be a comma unless commas delimit the columns. The unit of a
    column follows its name in brackets, or is in a separate line. Each time column is that of the
    columns after it. Integer samples of a WAV file
    are scaled to a full scale of 1. UFF and TDMS files need ``pip install "tribodyn[io]"``.

    Examples
    --------
    >>> import tempfile, pathlib
    >>> file = pathlib.Path(tempfile.mkdtemp()) / "run.csv"
    >>> _ = file.write_text("time [ms];acc [m/s^2]\n0;0,5\n2;0,25\n4;-0,5\n")
    >>> read(file)
    Recording(acc [m/s^2], 3 samples at 500 Hz, 0.006 s)
    """
    data = read_recording_data(path)
    names = list(data.channels) if channels is None else _requested_names(channels)
    for name in [*names, *(units or {}), *(sensitivity or {})]:
        if name not in data.channels:
            raise _no_channel(name, data.channels)
    samples = {name: data.channels[name] for name in names}
    channel_units = {name: data.units.get(name, "") for name in names} | dict(units or {})
    for name, text in (sensitivity or {}).items():
        if name in samples:
            factor, channel_units[name] = _from_sensor(text, channel_units[name] or "V", name)
            samples[name] = samples[name] * factor
    rate = _rate(data, names, sample_rate, path)
    return Recording(_aligned(samples, data, rate, path), rate, channel_units)


def _requested_names(channels: Iterable[str]) -> list[str]:
    names = [channels] if isinstance(channels, str) else list(channels)
    if not names:
        what, why = "channels is empty", "A recording needs at least one channel"
        raise InputError(what, Argument("channels"), why, "Omit it to read all channels")
    return names


def _rate(data: RecordingData, names: list[str], user_rate: float | None, path: object) -> float:
    """Sampling rate of the selected channels, from the file or from the user [Hz]."""
    rates = {name: data.rates[name] for name in names if name in data.rates}
    if user_rate is not None:
        require_positive("sample_rate", user_rate, "Hz")
        rates["argument sample_rate"] = float(user_rate)
    clocks = {id(data.times[name]): name for name in names if name in data.times}
    for name in clocks.values():
        time, size = data.times[name], data.channels[name].size
        if time.size != size:
            what = f"channel {name} has {size} samples and {time.size} times"
            why, remedy = "Each sample needs one time", "Correct the file, or remove the times"
            raise InputError(what, str(path), why, remedy)
        rates[f"times of {name}"] = rate_of(time, path, user_rate)
    if not rates:
        why = "It has neither a time column nor a rate"
        remedy = "Pass sample_rate in hertz, or 1 for times in samples, which is enough for orders"
        raise InputError(f"{path} has no sampling rate", Argument("sample_rate"), why, remedy)
    remedy = "Select channels of one rate with channels=[...], or omit sample_rate"
    return consistent_rate(rates, str(path), "the sampling rates differ", remedy)


def _aligned(
    samples: dict[str, Array], data: RecordingData, rate: float, path: object
) -> dict[str, Array]:
    """Samples of channels that start at different times, cut to the time that all of them have."""
    times = {name: start for name in samples if (start := data.start(name)) is not None}
    first = min(times.values(), default=0.0)
    late = {name: (start - first) * rate for name, start in times.items()}
    if max(late.values(), default=0.0) <= _SAME_START:
        return samples
    starts = ", ".join(f"{name} {start - first:.7g} s" for name, start in list(times.items())[:20])
    what, remedy = "its channels start at different times", "Select others with channels=[...]"
    unknown = [name for name in samples if name not in times]
    if unknown or (rate == 1.0 and not (data.rates or data.times)):
        why = f"They are {starts}; that of {unknown[0]} is not known" if unknown else (
            f"They are {starts}, and the sampling rate is not known"
        )  # fmt: skip
        raise InputError(what, str(path), why, remedy)
    begin = {name: round(number) for name, number in late.items()}
    start, end = max(begin.values()), min(begin[name] + v.size for name, v in samples.items())
    if end - start < 2:
        raise InputError(what, str(path), f"They have no time in common: {starts}", remedy)
    excess = max(abs(late[name] - begin[name]) for name in late)
    warn(
        "channels-aligned",
        f"{path}: {what} ({starts} after the first). They are cut to the {end - start} samples "
        f"from {start / rate:.7g} to {end / rate:.7g} s that all of them have"
        + (f", and remain up to {excess:.2g} of a sample apart." if excess > _SAME_START else "."),
        stacklevel=3,
    )
    return {name: v[start - begin[name] : end - begin[name]] for name, v in samples.items()}


def _from_sensor(text: str, unit: str, name: str) -> tuple[float, str]:
    """Factor from sensor voltage to the measured quantity, and its SI unit."""
    match = _SENSITIVITY.fullmatch(str(text))
    where = Argument(f"sensitivity of channel {name}")
    problem = Problem(
        f'sensitivity = "{text}"',
        where,
        f"Expected volts, or the unit of the channel ({unit}), per unit of the measured quantity",
        'Write "100 mV/g", "10 mV/N" or "0.5 V/(N*m)"',
    )
    if match is None:
        raise InputError(problem)
    measured_unit = match[3].strip().removeprefix("(").removesuffix(")")
    try:
        volts = float(match[1]) * convert(1.0, match[2].strip(), unit)
    except (InputError, ValueError):
        raise InputError(problem) from None
    if not (np.isfinite(volts) and volts != 0.0):
        raise InputError(problem)
    for si in MEASURED:
        try:
            return convert(1.0, measured_unit, si) / volts, si
        except (InputError, UnitProblemError):
            continue
    raise InputError(problem)


def in_si(values: Array, unit: str) -> tuple[Array, str]:
    """Convert a channel to the SI unit of its quantity; unchanged if the unit is unknown."""
    for si in MEASURED:
        try:
            zero = convert(0.0, unit, si)  # offset of temperatures in degC
            return values * (convert(1.0, unit, si) - zero) + zero, si
        except (InputError, UnitProblemError):
            continue
    return values, unit


def _no_channel(name: object, channels: Iterable[str]) -> InputError:
    available = list(channels)
    what = f"there is no channel {shortened(repr(name))}"
    why = f"It has {', '.join(available[:20])} {did_you_mean(name, available)}".rstrip()
    return InputError(what, Argument("channels"), why, "Use one of these names")
