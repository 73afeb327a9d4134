"""A computed motion beside a measured one: levels, mesh harmonics, spectra, errors."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np

from tribodyn.checks import require_number, require_whole
from tribodyn.errors import (
    Argument,
    InputError,
    require_between,
    require_one_of,
    require_positive,
    shortened,
)
from tribodyn.measurement.orders import order_spectrum
from tribodyn.measurement.recording import Recording
from tribodyn.record import Record, fact, quantity, record
from tribodyn.signals.spectrum import spectrum
from tribodyn.types import Array
from tribodyn.units import UnitProblemError, convert

Base = Literal["measured", "computed", "mean"]


@dataclass(frozen=True)
class Lines:
    """Amplitude spectra of one channel, computed and measured, in the unit of the former."""

    computed: tuple[Array, Array]  #: frequency [Hz] and peak amplitude, the gain included
    measured: tuple[Array, Array]


@record
class Comparison(Record):
    """Computed and measured values of channels side by side.

    Parameters
    ----------
    channel : (n,) array of str
        Measured channel of each row.
    measure : (n,) array of str
        ``rms`` of the whole alternating signal, ``rms of mesh harmonics``, ``mesh harmonic k``.
    unit : (n,) array of str
        Unit of the row.
    computed : (n,) array
        Computed value times the gain of its channel.
    measured : (n,) array
        Measured value.
    error : (n,) array
        Computed less measured value over the base [-].
    base : str
        What errors are divided by.
    mesh_frequency : float
        Of the computed motion [Hz].
    gains : mapping of str to float
        Transfer path of each channel: measured over computed signal.
    fitted : bool
        Whether the gains were fitted to the harmonics, which makes one of the errors small.
    lines : mapping of str to Lines
        Spectra by channel, for the figure.
    """

    channel: Any = quantity("row", axis=True, unit="")
    measure: Any = quantity("row", axis=True, unit="")
    unit: Any = quantity("row", axis=True, unit="")
    computed: Array = quantity("row", unit="")
    measured: Array = quantity("row", unit="")
    error: Array = quantity("row", unit="1")
    base: str = fact()
    mesh_frequency: float = fact()
    gains: Mapping[str, float] = field(default_factory=dict)
    fitted: bool = fact(default=False)
    lines: Mapping[str, Lines] = field(default_factory=dict)

    def __repr__(self) -> str:
        """One line."""
        worst = int(np.argmax(np.abs(self.error)))
        return (
            f"Comparison({len(self.gains)} channels, {self.channel.size} values, largest error "
            f"{100.0 * self.error[worst]:+.3g} % of the {self.base} {self.measure[worst]} of "
            f"{self.channel[worst]})"
        )


def compare(
    computed: Any,
    measured: Recording,
    channels: Mapping[str, str],
    *,
    harmonics: int = 5,
    base: Base = "measured",
    gain: Mapping[str, float] | float | Literal["fit"] = 1.0,
    mesh_frequency: float | None = None,
    frequency_tolerance: float = 0.005,
    angle: str | None = None,
    teeth: int | None = None,
) -> Comparison:
    """Lay a computed steady motion beside a measured one.

    Parameters
    ----------
    computed : Result or xarray.Dataset
        What :func:`tribodyn.run` or :func:`tribodyn.load_result` returns, of a steady state.
    measured : Recording
        At the same speed and torque.
    channels : mapping of str to str
        Measured channel to computed signal, such as ``{"acc": "acceleration_loa_pinion"}``.
    harmonics : int
        Mesh harmonics that are compared.
    base : {"measured", "computed", "mean"}
        What errors are divided by; ``"mean"`` is half the sum of both.
    gain : float, mapping or "fit"
        Transfer path from the computed place to the sensor: measured over computed signal, of all
        channels or by measured channel; ``"fit"`` takes the one of least squares over the mesh
        harmonics of each channel, and the result says so.
    mesh_frequency : float, optional
        Mesh frequency on the rig [Hz]; that of the computed motion by default.
    frequency_tolerance : float
        Part of the frequency by which a measured harmonic may lie beside it [-].
    angle : str, optional
        Channel with the angle of the shaft [rad], where the speed of the rig was not steady.
    teeth : int, optional
        Teeth of the gear on that shaft.

    Raises
    ------
    InputError
        If a channel or signal is not there, units do not match, the record is too short to part
        the harmonics, or an argument is out of its range.

    Notes
    -----
    Measured amplitudes are read with a flat-top window, within 0.12 %, as the largest line within
    the tolerance. Noise and other sources count in the rms of the whole signal, and not in that of
    the mesh harmonics.

    Examples
    --------
    >>> import xarray
    >>> made = xarray.Dataset(
    ...     {"force_spectrum": ("order", [3.0, 1.0], {"units": "N"})},
    ...     {"order": [1.0, 2.0]}, {"mesh_frequency": 100.0},
    ... )
    >>> time = np.arange(20000) / 10000.0
    >>> wave = 2.0 * np.cos(2 * np.pi * 100 * time) + np.cos(2 * np.pi * 200 * time)
    >>> compare(made, Recording({"cell": wave}, 1e4, {"cell": "N"}), {"cell": "force"}, harmonics=2)
    Comparison(1 channels, 4 values, largest error +50 % of the measured mesh harmonic 1 of cell)
    """
    data = computed.to_xarray() if hasattr(computed, "to_xarray") else computed
    count = require_whole("harmonics", harmonics)
    require_one_of("base", base, ("measured", "computed", "mean"))
    require_between("frequency_tolerance", frequency_tolerance, 0.0, 0.2)
    _refuse(measured, channels)
    own = _frequency(data)
    frequency = own if mesh_frequency is None else require_number("mesh_frequency", mesh_frequency)
    require_positive("mesh_frequency", frequency, "Hz")
    rows: list[tuple[str, str, str, float, float]] = []
    gains, lines = {}, {}
    for name, signal in channels.items():
        order, size, unit = _computed(data, signal, count)
        factor = _same_unit(measured.units.get(name, ""), unit, name)
        found, told = _measured(
            measured, name, frequency, count, frequency_tolerance, (angle, teeth)
        )
        own_lines = size[(order >= 1.0) & (np.abs(order - np.rint(order)) < 1e-9)][:count]
        gains[name] = _gain(gain, name, own_lines, factor * found)
        size, own_lines = gains[name] * size, gains[name] * own_lines
        whole = factor * float(np.std(measured[name]))
        rows.append((name, "rms", unit, _rms(size[order > 0.0]), whole))
        rows.append((name, "rms of mesh harmonics", unit, _rms(own_lines), factor * _rms(found)))
        for number, pair in enumerate(zip(own_lines, factor * found, strict=True), start=1):
            rows.append((name, f"mesh harmonic {number}", unit, float(pair[0]), float(pair[1])))
        lines[name] = Lines((order * own, size), (told[0], factor * told[1]))
    values, test = (np.array([row[column] for row in rows]) for column in (3, 4))
    below = {"measured": test, "computed": values, "mean": 0.5 * (values + test)}[base]
    with np.errstate(divide="ignore", invalid="ignore"):
        error = np.where(values == test, 0.0, (values - test) / below)
    channel, measure, units = (np.array([row[column] for row in rows]) for column in range(3))
    return Comparison(
        channel, measure, units, values, test, error, base, own, gains, gain == "fit", lines
    )


def _refuse(measured: Any, channels: Any) -> None:
    if not isinstance(measured, Recording):
        what, why = f"measured = {shortened(repr(measured))}", "Wanted: a Recording"
        raise InputError(what, Argument("measured"), why, "Read it with tribodyn.measurement.read")
    if not isinstance(channels, Mapping) or not channels:
        why = "A comparison lays channels beside computed signals"
        remedy = 'Write {"acc": "acceleration_loa_pinion"}'
        raise InputError("no channels are compared", Argument("channels"), why, remedy)


def _rms(amplitudes: Array) -> float:
    """Root mean square of sines of these peak amplitudes."""
    return float(np.sqrt(0.5 * np.sum(amplitudes**2)))


def _frequency(data: Any) -> float:
    try:
        return float(data.attrs["mesh_frequency"])
    except (AttributeError, KeyError, TypeError, ValueError):
        why, remedy = "Wanted: the result of tribodyn.run, or its data set", "Give the result"
        raise InputError("it has no mesh frequency", Argument("computed"), why, remedy) from None


def _computed(data: Any, signal: str, count: int) -> tuple[Array, Array, str]:
    """Orders of the mesh, peak amplitudes and unit of a computed signal."""
    name = f"{signal}_spectrum"
    if name not in data:
        names = [str(each) for each in data]
        known = sorted(each.removesuffix("_spectrum") for each in names if "_spectrum" in each)
        raise InputError(
            f'there is no computed signal "{signal}"',
            Argument("channels"),
            f"It has {', '.join(known)}" if known else "It is no steady state",
            "Write one of these" if known else 'Compute with solver.method = "steady"',
        )
    order = np.asarray(data["order"].values, dtype=float)
    if order.max() < count:
        why = f"The computed motion holds {order.max():.0f}"
        raise InputError(f"harmonics = {count}", Argument("harmonics"), why, "Ask for fewer")
    return order, np.asarray(data[name].values, dtype=float), str(data[name].attrs.get("units", ""))


def _same_unit(given: str, wanted: str, name: str) -> float:
    """Factor from the unit of the measured channel to that of the computed signal."""
    try:
        return float(convert(1.0, given, wanted)) if given else 1.0
    except UnitProblemError as error:
        what = f'channel {name} is in "{given}", the computed signal in "{wanted}"'
        remedy = "Give units or sensitivity when reading it"
        raise InputError(what, Argument("channels"), str(error), remedy) from None


def _measured(
    recording: Recording, name: str, frequency: float, count: int, tolerance: float, shaft: Any
) -> tuple[Array, tuple[Array, Array]]:
    """Amplitudes of the mesh harmonics of a channel, and its whole spectrum."""
    angle, teeth = shaft
    if angle is not None:
        per = require_whole("teeth", teeth, why="the teeth of the gear on that shaft,")
        made = order_spectrum(recording[name], recording[angle], per * (count + 0.5))
        places, size = made.orders / per, made.amplitudes
    else:
        plain = spectrum(recording[name], recording.sample_rate)
        places, size = plain.frequency / frequency, plain.amplitude
    numbers = np.arange(1, count + 1)
    if places[-1] < count * (1.0 + tolerance):
        what = f"mesh harmonic {count} is beyond the record"
        why = f"Sampled with {recording.sample_rate:g} Hz it reaches harmonic {places[-1]:.3g}"
        raise InputError(what, Argument("harmonics"), why, "Ask for fewer, or sample faster")
    if places[1] > 0.05:
        what = f"the record lasts {recording.duration:g} s"
        why = "Mesh harmonics are parted from what lies beside them over 20 mesh cycles or more"
        raise InputError(what, Argument("measured"), why, "Record longer")
    found = [
        size[np.abs(places - number) <= max(tolerance * number, 0.51 * places[1])].max()
        for number in numbers
    ]
    return np.array(found), (places * frequency, size)


def _gain(given: Any, name: str, computed: Array, measured: Array) -> float:
    """Transfer path of a channel."""
    if isinstance(given, str):
        require_one_of("gain", given, ("fit",))
        square = float(computed @ computed)
        if square == 0.0:
            what = f"the computed harmonics for {name} are all zero"
            why = "It scales one signal to the other"
            raise InputError(what, Argument("gain"), why, "Give the gain as a number")
        return float(computed @ measured) / square
    value = given.get(name, 1.0) if isinstance(given, Mapping) else given
    require_positive("gain", value)
    return float(value)
