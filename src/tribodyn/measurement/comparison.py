"""Comparison of a computed with a measured response: speed, levels, mesh harmonics, errors."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np

from tribodyn.errors import (
    Argument,
    InputError,
    require_between,
    require_one_of,
    require_positive,
    shortened,
)
from tribodyn.measurement.mesh_harmonics import (
    MeshHarmonics,
    harmonics_of,
    speed_by_angle,
    speed_by_lines,
    speed_by_tacho,
    warn_of_harmonics,
    warn_of_speed,
)
from tribodyn.measurement.mesh_speed import MeshSpeed
from tribodyn.measurement.recording import Recording
from tribodyn.nomenclature import require_number, require_whole
from tribodyn.record import Record, fact, quantity, record
from tribodyn.types import Array, Texts
from tribodyn.units import UnitProblemError, convert

Base = Literal["measured", "computed", "mean"]
_Row = tuple[str, str, str, float, float, float]
#: Band of a recording over its sampling rate: above it anti-alias filters fall.
_BAND = 0.4
#: Directions in the names of signals by the axis in the names of coordinates.
_DIRECTIONS = {
    **dict.fromkeys("xv", ("oloa", "x")),
    **dict.fromkeys("yw", ("loa", "y")),
    "z": ("axial", "z"),
}


@dataclass(frozen=True)
class Lines:
    """Amplitude spectra of one channel, computed and measured, in the unit of the former."""

    computed: tuple[Array, Array]  #: frequency [Hz] and peak amplitude, the gain included
    measured: tuple[Array, Array]


@record
class Comparison(Record):
    """Computed and measured values of channels and their differences.

    Parameters
    ----------
    channel : (n,) array of str
        Measured channel of each row.
    measure : (n,) array of str
        ``rms`` of the alternating signal in the band of the recording, ``rms of mesh harmonics``,
        ``mesh harmonic k``.
    unit : (n,) array of str
        Unit of the row.
    computed : (n,) array
        Computed value times the gain of its channel.
    measured : (n,) array
        Measured value; NaN for harmonics of a recording whose speed was not found.
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
    noise : (n,) array
        Amplitude that noise alone has at a mesh harmonic; 0 in the rows of rms.
    speed_ratio : float
        Mean mesh frequency of the recording over that of the computed motion [-]; NaN if it was
        not found.
    speed_uncertainty : float
        Its standard uncertainty [-], without that of the sampling clock.
    speed_range : tuple of float
        Least and largest ratio during the recording [-].
    speed_method : str
        How the speed was found.
    shares : mapping of str to float
        Part of the alternating mean square of each channel that is in its mesh harmonics [-].
    """

    channel: Texts = quantity("row", axis=True, unit="")
    measure: Texts = quantity("row", axis=True, unit="")
    unit: Texts = quantity("row", axis=True, unit="")
    computed: Array = quantity("row", unit="")
    measured: Array = quantity("row", unit="")
    error: Array = quantity("row", unit="1")
    base: str = fact()
    mesh_frequency: float = fact()
    gains: Mapping[str, float] = field(default_factory=dict)
    fitted: bool = fact(default=False)
    lines: Mapping[str, Lines] = field(default_factory=dict)
    noise: Any = quantity("row", unit="", default=None)
    speed_ratio: float = fact(default=1.0)
    speed_uncertainty: float = fact(default=0.0)
    speed_range: tuple[float, float] = (1.0, 1.0)
    speed_method: str = fact(default="")
    shares: Mapping[str, float] = field(default_factory=dict)

    @property
    def speed_text(self) -> str:
        """Speed of the recording with its uncertainty, and how it was found, as a sentence."""
        if not np.isfinite(self.speed_ratio):
            return f"The speed of the recording was not found: {self.speed_method}."
        decimals = 6
        if self.speed_uncertainty > 0.0:
            decimals = int(np.clip(1 - np.floor(np.log10(self.speed_uncertainty)), 4, 9))
        low, high = self.speed_range
        wander = f", from {low:.4f} to {high:.4f} during it" if high - low > 2e-4 else ""
        return (
            "Mesh frequency of the recording over the computed one: "
            f"{self.speed_ratio:.{decimals}f} (standard uncertainty {self.speed_uncertainty:.2g})"
            f"{wander}; by {self.speed_method}."
        )

    def __repr__(self) -> str:
        """One line."""
        worst = int(np.argmax(np.where(np.isnan(self.error), -1.0, np.abs(self.error))))
        ratio = f"speed ratio {self.speed_ratio:.5g}"
        speed = ratio if np.isfinite(self.speed_ratio) else "speed not found"
        return (
            f"Comparison({len(self.gains)} channels, {self.channel.size} values, largest error "
            f"{100.0 * self.error[worst]:+.3g} % of the {self.base} {self.measure[worst]} of "
            f"{self.channel[worst]}; {speed})"
        )


def compare(
    computed: object,
    measured: Recording,
    channels: Mapping[str, str],
    *,
    harmonics: int = 5,
    base: Base = "measured",
    gain: Mapping[str, float] | float | Literal["fit"] = 1.0,
    mesh_frequency: float | None = None,
    frequency_tolerance: float = 0.05,
    angle: str | None = None,
    teeth: int | None = None,
    tacho: str | None = None,
    pulses: int = 1,
    mesh: str | None = None,
) -> Comparison:
    """Compare a computed steady-state response with a measured one.

    Parameters
    ----------
    computed : Result, MachineResult or xarray.Dataset
        Steady-state result of :func:`tribodyn.run` or :func:`tribodyn.load_result`.
    measured : Recording
        Recording at about the same speed and the same torque.
    channels : mapping of str to str
        Measured channel to computed signal, such as ``{"acc": "acceleration_loa_pinion"}``, or
        ``"housing.seat A.acceleration_y"`` of a machine; every sensor of ``recording`` as well.
    harmonics : int
        Mesh harmonics that are compared.
    base : {"measured", "computed", "mean"}
        Reference of the errors; ``"mean"`` is the mean of measured and computed value.
    gain : float, mapping or "fit"
        Transfer path from the computed place to the sensor: measured over computed signal, of all
        channels or by measured channel; ``"fit"`` takes the one of least squares over the mesh
        harmonics of each channel, and the result says so.
    mesh_frequency : float, optional
        Mesh frequency on the rig, about which its mesh lines are searched [Hz]; that of the
        computed motion by default.
    frequency_tolerance : float
        Largest relative deviation of the measured mesh frequency from that [-].
    angle : str, optional
        Channel with the angle of a shaft [rad].
    teeth : int, optional
        Teeth of the gear on the shaft with angle or tachometer; of the pinion, or of the first gear
        of the mesh of a machine, by default.
    tacho : str, optional
        Channel with the pulses of a tachometer, or with the speed, by its unit of rpm or rad/s.
    pulses : int
        Pulses of the tachometer in a revolution.
    mesh : str, optional
        Mesh of a machine whose harmonics are compared; the first by default. The rms of the whole
        signal is that of all meshes.

    Raises
    ------
    InputError
        If a channel or signal is missing, units do not match, the record is too short to separate
        the harmonics, no harmonic exceeds the noise where a gain is to be fitted, or an
        argument is out of its range.

    Warns
    -----
    ModelWarning
        ``speed-not-found``, ``speed-ambiguous`` or ``speed-off`` where the speed of the recording
        is not that of the computed motion for sure; ``harmonics-in-noise`` and
        ``harmonics-smeared`` where amplitudes are off by more than 5 %;
        ``signal-outside-harmonics`` where less than half of the alternating mean square of a
        channel is in the mesh harmonics.

    Notes
    -----
    Measured amplitudes are those over the angle of the mesh (:func:`order_spectrum`), which comes
    from the tachometer, from the channel with the angle, or from the mesh lines of all compared
    channels (:func:`mesh_speed`). The computed rms is that of the band of the recording: from 0.4
    to 0.5 of the sampling rate it falls as by an anti-alias filter. Noise and other sources count
    in the measured one, and not in that of the mesh harmonics.

    Examples
    --------
    >>> import xarray
    >>> computed = xarray.Dataset(
    ...     {"force_spectrum": ("order", [3.0, 1.0], {"units": "N"})},
    ...     {"order": [1.0, 2.0]}, {"mesh_frequency": 100.0},
    ... )
    >>> time = np.arange(20000) / 10000.0
    >>> wave = 2.0 * np.cos(2 * np.pi * 100 * time) + np.cos(2 * np.pi * 200 * time)
    >>> recording = Recording({"cell": wave}, 1e4, {"cell": "N"})
    >>> comparison = compare(computed, recording, {"cell": "force"}, harmonics=2)
    >>> comparison.measured.round(3).tolist()
    [1.581, 1.581, 2.0, 1.0]
    >>> round(comparison.speed_ratio, 4)
    1.0
    """
    data = _data(computed, mesh)
    count = require_whole("harmonics", harmonics)
    require_one_of("base", base, ("measured", "computed", "mean"))
    require_between("frequency_tolerance", frequency_tolerance, 0.0, 0.2)
    _refuse(measured, channels)
    computed_frequency = _frequency(data, computed)
    frequency = computed_frequency
    if mesh_frequency is not None:
        frequency = require_number("mesh_frequency", mesh_frequency)
    require_positive("mesh_frequency", frequency, "Hz")
    signals = {name: _computed(computed, data, signal, count) for name, signal in channels.items()}
    factors = {
        name: _same_unit(measured.units.get(name, ""), unit, name)
        for name, (_, _, unit) in signals.items()
    }
    gears = _gears(computed, data)
    shaft = (angle, tacho, pulses, teeth if teeth is not None else next(iter(gears), None))
    speed = _speed(measured, channels, (frequency, count, frequency_tolerance), gears, shaft)
    rows: list[_Row] = []
    gains, lines, shares = {}, {}, {}
    for name, (order, size, unit) in signals.items():
        harmonic = harmonics_of(measured[name], speed, count, gears)
        if speed.located:
            warn_of_harmonics(name, harmonic)
            shares[name] = harmonic.share
        at_harmonics = _at_harmonics(order, size, count)
        gains[name] = _gain(gain, name, at_harmonics, (harmonic, factors[name]), speed)
        size, at_harmonics = gains[name] * size, gains[name] * at_harmonics
        passed = _passed(order * frequency / measured.sample_rate)[order > 0.0]
        level = _rms(size[order > 0.0] * passed), factors[name] * float(np.std(measured[name]))
        rows.append((name, "rms", unit, *level, 0.0))
        rows += _harmonic_rows(name, unit, at_harmonics, (harmonic, factors[name]), speed.located)
        place, amplitude = harmonic.spectrum
        scale = speed.mesh_frequency if speed.located else frequency
        lines[name] = Lines(
            (order * computed_frequency, size), (place * scale, factors[name] * amplitude)
        )
    channel, measure, units, values, test, noise = map(np.array, zip(*rows, strict=True))
    errors, fitted, per = _errors(values, test, base), gain == "fit", frequency / computed_frequency
    ratio, uncertainty = per * speed.ratio, per * speed.uncertainty
    limits = (per * speed.lowest, per * speed.highest)
    columns = (channel, measure, units, values, test, errors)
    recorded = (noise, ratio, uncertainty, limits, speed.method, shares)
    return Comparison(*columns, base, computed_frequency, gains, fitted, lines, *recorded)


def _at_harmonics(order: Array, size: Array, count: int) -> Array:
    """Sizes of the lines at the orders 1, 2, ..., zero without a line."""
    number = np.rint(order)
    lines = (np.abs(order - number) < 1e-9) & (number >= 1) & (number <= count)
    sizes = np.zeros(count)
    sizes[number[lines].astype(int) - 1] = size[lines]
    return sizes


def _harmonic_rows(
    name: str, unit: str, computed: Array, measured: tuple[MeshHarmonics, float], located: bool
) -> list[_Row]:
    """Rows of the mesh harmonics of a channel, the measured ones times a factor."""
    harmonic, factor = measured
    amplitude = factor * harmonic.amplitude if located else np.full(computed.size, np.nan)
    level = _rms(computed), _rms(amplitude)
    values = zip(computed.tolist(), amplitude.tolist(), strict=True)
    noise = (factor * harmonic.noise).tolist()
    return [
        (name, "rms of mesh harmonics", unit, *level, 0.0),
        *(
            (name, f"mesh harmonic {k}", unit, *pair, noise[k - 1])
            for k, pair in enumerate(values, start=1)
        ),
    ]


def _errors(values: Array, test: Array, base: Base) -> Array:
    """Computed less measured values over the base."""
    divisor = {"measured": test, "computed": values, "mean": 0.5 * (values + test)}[base]
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(values == test, 0.0, (values - test) / divisor)


def _data(computed: object, mesh: str | None) -> Any:
    """Data set of a result; of a machine its spectra over the order of a mesh."""
    if hasattr(computed, "mesh_spectra"):
        return computed.mesh_spectra(mesh)
    if mesh is not None:
        what, why = f'mesh = "{mesh}"', "A pair of gears and a stage have one mesh frequency"
        raise InputError(what, Argument("mesh"), why, "Leave it out")
    return computed.to_xarray() if hasattr(computed, "to_xarray") else computed


def _gears(computed: object, data: Any) -> tuple[int, ...]:
    """Teeth of both gears of a result; empty where it is only a data set."""
    if "teeth" in getattr(data, "attrs", {}):
        return tuple(map(int, data.attrs["teeth"]))
    gears = getattr(getattr(computed, "case", None), "gears", None)
    teeth = (getattr(getattr(gears, name, None), "teeth", None) for name in ("pinion", "wheel"))
    return tuple(int(number) for number in teeth if number is not None)


def _speed(
    measured: Recording, channels: Mapping[str, str], mesh: Any, gears: tuple[int, ...], shaft: Any
) -> MeshSpeed:
    """Speed of the recording from the angle of a shaft, or else from its mesh lines."""
    frequency, count, tolerance = mesh
    angle, tacho, pulses, teeth = shaft
    if angle is not None and tacho is not None:
        what, why = f'angle = "{angle}" and tacho = "{tacho}"', "Both define the angle of a shaft"
        raise InputError(what, Argument("tacho"), why, "Leave one out")
    if angle is None and tacho is None:
        if count * frequency >= 0.5 * measured.sample_rate:
            what = f"mesh harmonic {count} is beyond the record"
            reach = 0.5 * measured.sample_rate / frequency
            why = f"Sampled with {measured.sample_rate:g} Hz it reaches harmonic {reach:.3g}"
            raise InputError(
                what, Argument("harmonics"), why, "Request fewer harmonics, or sample faster"
            )
        return speed_by_lines(measured, channels, frequency, count, tolerance, gears)
    per = require_whole("teeth", teeth, why="the teeth of the gear on that shaft,")
    if tacho is not None:
        per_turn = require_whole("pulses", pulses)
        speed = speed_by_tacho(measured, tacho, per_turn, per, frequency)
    else:
        speed = speed_by_angle(measured, str(angle), per, frequency)
    warn_of_speed(speed, frequency, tolerance)
    return speed


def _refuse(measured: object, channels: object) -> None:
    if not isinstance(measured, Recording):
        what, why = f"measured = {shortened(repr(measured))}", "Expected a Recording"
        raise InputError(what, Argument("measured"), why, "Read it with tribodyn.measurement.read")
    if not isinstance(channels, Mapping) or not channels:
        why = "A comparison needs a computed signal for each channel"
        remedy = 'Write {"acc": "acceleration_loa_pinion"}'
        raise InputError("no channels are compared", Argument("channels"), why, remedy)


def _rms(amplitudes: Array) -> float:
    """Root mean square of sines of these peak amplitudes."""
    return float(np.sqrt(0.5 * np.sum(amplitudes**2)))


def _passed(frequency: Array) -> Array:
    """Gain of an anti-alias filter over the frequency, in sampling rates."""
    fall = np.clip((frequency - _BAND) / (0.5 - _BAND), 0.0, 1.0)
    return np.asarray(0.5 * (1.0 + np.cos(np.pi * fall)))


def _frequency(data: Any, computed: Any) -> float:
    if "mesh_frequency" not in getattr(data, "attrs", {}) and _has_turning_motion(computed):
        return float(computed.turning_motion.mesh_frequency)
    try:
        return float(data.attrs["mesh_frequency"])
    except (AttributeError, KeyError, TypeError, ValueError):
        why, remedy = "Expected the result of tribodyn.run or its dataset", "Pass the result"
        raise InputError("it has no mesh frequency", Argument("computed"), why, remedy) from None


def _has_turning_motion(computed: object) -> bool:
    """Whether there is a motion that recordings are made of, without computing it."""
    return hasattr(type(computed), "turning_motion")


def _computed(computed: Any, data: Any, signal: str, count: int) -> tuple[Array, Array, str]:
    """Orders of the mesh, amplitudes and unit of a signal; with faults as in a recording."""
    name = _name_in_data(data, signal)
    faults = getattr(getattr(computed, "case", None), "faults", None)
    several_turns = name is None or faults or hasattr(computed, "mesh_spectra")
    if _has_turning_motion(computed) and several_turns:
        try:
            unit = computed.turning_motion.signal(signal)[1]
        except InputError:
            if name is None:
                raise
        else:
            frequency, lines = computed.turning_motion.harmonics(signal)
            order = frequency[1:] / _frequency(data, computed)
            return _resolved(order, count), np.abs(lines[1:]), unit
    if name is None:
        names = [str(entry) for entry in data]
        available = sorted(
            entry.removesuffix("_spectrum") for entry in names if "_spectrum" in entry
        )
        raise InputError(
            f'there is no computed signal "{signal}"',
            Argument("channels"),
            f"It has {', '.join(available)}" if available else "It is not a steady state",
            "Use one of these" if available else 'Compute with solver.method = "steady"',
        )
    order = _resolved(np.asarray(data["order"].values, dtype=float), count)
    return order, np.asarray(data[name].values, dtype=float), str(data[name].attrs.get("units", ""))


def _name_in_data(data: Any, signal: str) -> str | None:
    """Name of the spectrum of a signal, also by the name of its coordinate."""
    gear, _, axis = signal.rpartition("_")
    names = [signal, *(f"acceleration_{way}_{gear}" for way in _DIRECTIONS.get(axis, ()))]
    names += ["dynamic_transmission_error"] if signal == "transmission_error" else []
    return next((f"{name}_spectrum" for name in names if f"{name}_spectrum" in data), None)


def _resolved(order: Array, count: int) -> Array:
    """Orders of a computed motion that holds so many harmonics."""
    if order.max() < count:
        why = f"The computed motion holds {order.max():.0f}"
        raise InputError(
            f"harmonics = {count}", Argument("harmonics"), why, "Request fewer harmonics"
        )
    return order


def _same_unit(unit: str, target_unit: str, name: str) -> float:
    """Factor from the unit of the measured channel to that of the computed signal."""
    try:
        return float(convert(1.0, unit, target_unit)) if unit else 1.0
    except UnitProblemError as error:
        what = f'channel {name} is in "{unit}", the computed signal in "{target_unit}"'
        remedy = "Pass units or sensitivity to read"
        raise InputError(what, Argument("channels"), str(error), remedy) from None


def _gain(
    gain: Any, name: str, computed: Array, measured: tuple[MeshHarmonics, float], speed: MeshSpeed
) -> float:
    """Transfer path of a channel; a fitted one is that of the harmonics above the noise."""
    if not isinstance(gain, str):
        value = gain.get(name, 1.0) if isinstance(gain, Mapping) else gain
        require_positive("gain", value)
        return float(value)
    require_one_of("gain", gain, ("fit",))
    harmonic, factor = measured
    clear = harmonic.clear
    if not (speed.located and clear.any()):
        what = f"no gain can be fitted for channel {name}"
        why = "None of its mesh harmonics exceeds the noise"
        if not speed.located:
            why = f"The speed of the recording is unknown: {speed.method}"
        remedy = "Pass the gain as a number, or correct the channel, the speed or the tachometer"
        raise InputError(what, Argument("gain"), why, remedy)
    square = float(computed[clear] @ computed[clear])
    if square == 0.0:
        what = f"the computed harmonics for {name} are all zero"
        why = "A gain cannot scale zero to the measured signal"
        raise InputError(what, Argument("gain"), why, "Pass the gain as a number")
    return factor * float(computed[clear] @ harmonic.amplitude[clear]) / square
