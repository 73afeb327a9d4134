"""A record of a test rig: channels that were sampled together, with their units."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import Any

import numpy as np

from tribodyn.errors import Argument, InputError, Problem, did_you_mean, require_positive, shortened
from tribodyn.measurement.readers.content import MEASURED, Content, rate_of
from tribodyn.measurement.readers.recognised import content_of
from tribodyn.record import Parts, Record, fact, record
from tribodyn.signals.angular_resampling import checked_signal
from tribodyn.types import Array
from tribodyn.units import UnitProblemError, convert

_SENSITIVITY = re.compile(r"\s*([0-9.eE+-]+)\s*([^/]+)/\s*(.+?)\s*")


@record
class Recording(Record):
    """Channels of a test rig, sampled together at one rate.

    Parameters
    ----------
    channels : mapping of str to (n,) array
        Samples by the name of the channel, in its unit.
    sample_rate : float
        Samples per second [Hz].
    units : mapping of str to str
        Unit of each channel; a channel that is not named has none.

    Raises
    ------
    InputError
        If there is no channel, a sample is no finite number, or the channels differ in length.

    Examples
    --------
    >>> time = np.arange(2000) / 1000.0
    >>> made = Recording({"acc": np.sin(2 * np.pi * 50.0 * time)}, 1000.0, {"acc": "m/s^2"})
    >>> made
    Recording(acc [m/s^2], 2000 samples at 1000 Hz, 2 s)
    >>> made.cut(0.5, 1.0)["acc"].size
    500
    """

    channels: Mapping[str, Array]
    sample_rate: float = fact()
    units: Mapping[str, str]

    def __post_init__(self) -> None:
        require_positive("sample_rate", self.sample_rate, "Hz")
        named = isinstance(self.channels, Mapping) and isinstance(self.units, Mapping)
        if not named or not self.channels or not all(isinstance(n, str) for n in self.channels):
            what = f"channels = {shortened(repr(self.channels))}"
            why = "A recording is a mapping of names to samples, and one of names to units"
            remedy = 'Write Recording({"acc": samples}, 51200.0, {"acc": "m/s^2"})'
            raise InputError(what, Argument("channels"), why, remedy)
        read = {n: checked_signal(v, 1, f"channel {n}") for n, v in self.channels.items()}
        sizes = {values.size for values in read.values()}
        if len(sizes) > 1:
            told = ", ".join(f"{name} {values.size}" for name, values in read.items())
            what = "the channels have different numbers of samples"
            why = f"All were sampled together: {told}"
            remedy = "Take channels of one length, as with channels=[...] of read"
            raise InputError(what, Argument("channels"), why, remedy)
        units = {name: str(self.units.get(name, "")) for name in read}
        object.__setattr__(self, "channels", MappingProxyType(read))
        object.__setattr__(self, "units", MappingProxyType(units))
        object.__setattr__(self, "sample_rate", float(self.sample_rate))

    def __getitem__(self, name: str) -> Array:
        """Samples of one channel."""
        if name not in self.channels:
            raise _no_channel(name, self.channels)
        return self.channels[name]

    @property
    def time(self) -> Array:
        """Time of each sample from the first [s]."""
        size = next(iter(self.channels.values())).size
        return np.arange(size) / self.sample_rate

    @property
    def duration(self) -> float:
        """Number of samples over the sampling rate [s]."""
        return float(next(iter(self.channels.values())).size / self.sample_rate)

    def cut(self, start: float, end: float) -> Recording:
        """Part of the recording.

        Parameters
        ----------
        start, end : float
            Times from the first sample [s].

        Returns
        -------
        Recording
            The samples from the start on, up to but without the end.

        Raises
        ------
        InputError
            If the times are not within the recording, one after the other.
        """
        if not 0.0 <= start < end <= self.duration * (1.0 + 1e-12):
            why = f"The recording lasts {self.duration:g} s"
            remedy = "Give two times within it, the earlier first"
            raise InputError(f"from {start:g} to {end:g} s", "arguments start and end", why, remedy)
        kept = slice(*(int(np.ceil(at * self.sample_rate - 1e-9)) for at in (start, end)))
        parts = {name: values[kept] for name, values in self.channels.items()}
        return Recording(parts, self.sample_rate, self.units)

    def __repr__(self) -> str:
        """One line."""
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
        The file. What it is is told by its content; text may be compressed (``.gz``).
    channels : iterable of str, optional
        Channels to read; all by default.
    sample_rate : float, optional
        Samples per second [Hz], where the file has no column of times and no rate.
    units : mapping of str to str, optional
        Units of channels, where the file has none or a wrong one.
    sensitivity : mapping of str to str, optional
        Sensitivity of the sensor of a channel that holds its voltage, such as ``"100 mV/g"``:
        the channel comes back in the SI unit of what was measured.

    Raises
    ------
    InputError
        If the file cannot be read, is not what its name says, is cut short, holds samples that
        are no finite numbers, times that are not evenly spaced, or no sampling rate.

    Notes
    -----
    A CSV file may begin with lines of any text. Its columns are parted by comma, semicolon, tab
    or blanks; the decimal sign may be a comma where the columns are not parted by one. The unit
    of a column stands in brackets behind its name, or in a line of its own. Full scale of a WAV
    file of whole numbers is 1. UFF and TDMS files need ``pip install "tribodyn[io]"``.

    Examples
    --------
    >>> import tempfile, pathlib
    >>> file = pathlib.Path(tempfile.mkdtemp()) / "run.csv"
    >>> _ = file.write_text("time [ms];acc [m/s^2]\n0;0,5\n2;0,25\n4;-0,5\n")
    >>> read(file)
    Recording(acc [m/s^2], 3 samples at 500 Hz, 0.006 s)
    """
    found = content_of(path)
    names = list(found.channels) if channels is None else _chosen(channels)
    for name in [*names, *(units or {}), *(sensitivity or {})]:
        if name not in found.channels:
            raise _no_channel(name, found.channels)
    kept = {name: found.channels[name] for name in names}
    told = {name: found.units.get(name, "") for name in names} | dict(units or {})
    for name, text in (sensitivity or {}).items():
        if name in kept:
            factor, told[name] = _from_sensor(text, told[name] or "V", name)
            kept[name] = kept[name] * factor
    return Recording(kept, _rate(found, names, sample_rate, path), told)


def _chosen(channels: Iterable[str]) -> list[str]:
    names = [channels] if isinstance(channels, str) else list(channels)
    if not names:
        what, why = "no channel is asked for", "A recording without channels has nothing to compare"
        raise InputError(what, Argument("channels"), why, "Leave it out for all")
    return names


def _rate(found: Content, names: list[str], given: float | None, path: Any) -> float:
    """Sampling rate of the chosen channels: of the file, or as given."""
    rates = {name: found.rates[name] for name in names if name in found.rates}
    if given is not None:
        require_positive("sample_rate", given, "Hz")
        rates["argument sample_rate"] = float(given)
    clocks = {id(found.times[name]): name for name in names if name in found.times}
    for name in clocks.values():
        time, size = found.times[name], found.channels[name].size
        if time.size != size:
            what = f"channel {name} has {size} samples, its times are {time.size}"
            why, remedy = "Each sample has its own time", "Correct the file, or leave the times out"
            raise InputError(what, str(path), why, remedy)
        rates[f"times of {name}"] = rate_of(time, path, given)
    if not rates:
        why, remedy = "It has neither a column named time nor a rate", "Give sample_rate in hertz"
        raise InputError(f"{path} tells no sampling rate", Argument("sample_rate"), why, remedy)
    first = next(iter(rates.values()))
    if any(abs(rate - first) > 1e-5 * first for rate in rates.values()):
        told = ", ".join(f"{name} {rate:.7g} Hz" for name, rate in rates.items())
        remedy = "Read channels of one rate with channels=[...], or leave sample_rate out"
        raise InputError("the sampling rates differ", str(path), told, remedy)
    return first


def _from_sensor(text: str, unit: str, name: str) -> tuple[float, str]:
    """Factor from the voltage of a sensor to what it measures, and its unit in SI."""
    match = _SENSITIVITY.fullmatch(str(text))
    where = Argument(f"sensitivity of channel {name}")
    wrong = Problem(
        f'sensitivity = "{text}"',
        where,
        f"Wanted: volts, or what the channel holds ({unit}), over the unit that is measured",
        'Write "100 mV/g", "10 mV/N" or "0.5 V/(N*m)"',
    )
    if match is None:
        raise InputError(wrong)
    below = match[3].strip().removeprefix("(").removesuffix(")")
    try:
        volts = float(match[1]) * convert(1.0, match[2].strip(), unit)
    except (InputError, ValueError):
        raise InputError(wrong) from None
    if not (np.isfinite(volts) and volts != 0.0):
        raise InputError(wrong)
    for si in MEASURED:
        try:
            return convert(1.0, below, si) / volts, si
        except (InputError, UnitProblemError):
            continue
    raise InputError(wrong)


def in_si(values: Array, unit: str) -> tuple[Array, str]:
    """A channel in the SI unit of what it measures; as it is where its unit is not known."""
    for si in MEASURED:
        try:
            zero = convert(0.0, unit, si)  # of temperatures in degC
            return values * (convert(1.0, unit, si) - zero) + zero, si
        except (InputError, UnitProblemError):
            continue
    return values, unit


def _no_channel(name: object, known: Iterable[str]) -> InputError:
    names = list(known)
    what = f"there is no channel {shortened(repr(name))}"
    why = f"It has {', '.join(names[:20])} {did_you_mean(name, names)}".rstrip()
    return InputError(what, Argument("channels"), why, "Write the name as it stands there")
