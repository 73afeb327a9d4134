"""Checks that all analyses of recorded signals share: finite, long enough, rising, fast enough."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.errors import InputError, require_positive
from tribodyn.types import Array


def checked_signal(signal: Any, least: int = 8, name: str = "signal") -> Array:
    """Return a signal as floats, or say what is wrong with it."""
    where = f"argument {name}"
    given = np.asarray(signal)
    if given.dtype.kind not in "biuf":
        raise InputError(
            f"{name} holds {given.dtype} values",
            where=where,
            why="A recorded signal holds real numbers",
            remedy="Pass real and imaginary parts one by one, and text as numbers",
        )
    values = given.astype(float)
    if values.ndim != 1:
        raise InputError(
            f"{name} has the shape {values.shape}",
            where=where,
            why="One recorded signal is a row of numbers, (n,)",
            remedy="Pass the columns of a record one by one",
        )
    bad = np.flatnonzero(~np.isfinite(values))
    if bad.size:
        raise InputError(
            f"{name} is {values[bad[0]]} at sample {bad[0]} ({bad.size} such samples)",
            where=where,
            why="A spectrum needs every sample",
            remedy="Cut the record there, or fill short gaps by interpolation",
        )
    if values.size < least:
        raise InputError(
            f"{name} has {values.size} samples",
            where=where,
            why=f"At least {least} are needed",
            remedy="Record longer",
        )
    return values


def checked_rising(values: Any, size: int, name: str, unit: str) -> Array:
    """Return times or rotation angles that rise from sample to sample."""
    rising = checked_signal(values, 2, name)
    if rising.size != size:
        raise InputError(
            f"{name} has {rising.size} samples, the signal has {size}",
            where=f"argument {name}",
            why="Each sample of the signal has its own value",
        )
    falls = np.flatnonzero(np.diff(rising) <= 0.0)
    if falls.size:
        first = int(falls[0])
        raise InputError(
            f"{name} goes from {rising[first]:.6g} to {rising[first + 1]:.6g} {unit} "
            f"at sample {first + 1}",
            where=f"argument {name}",
            why="It must rise from sample to sample",
            remedy="Sort the record, drop repeated samples, or count the rotation without wrap",
        )
    return rising


def refuse_above_half(highest: float, sampling_rate: float, what: str, where: str) -> None:
    """Refuse a frequency that the sampling cannot tell from a lower one."""
    require_positive("sampling_rate", sampling_rate, "Hz")
    if not highest < 0.5 * sampling_rate:
        raise InputError(
            f"{what} is at {highest:.6g} Hz",
            where=where,
            why=f"Sampled with {sampling_rate:.6g} Hz, only frequencies below "
            f"{0.5 * sampling_rate:.6g} Hz can be told apart (Nyquist)",
            remedy="Sample faster, or ask for less",
        )


def window_values(window: str, length: int) -> Array:
    """Return a window of SciPy, periodic so that its lines fall on bins."""
    from scipy.signal import get_window

    try:
        return np.asarray(get_window(window, length, fftbins=True), dtype=float)
    except (ValueError, TypeError) as error:
        raise InputError(
            f"there is no window {window!r}",
            where="argument window",
            why=str(error),
            remedy='Take "flattop" for amplitudes, "hann" for noise, "boxcar" for none',
        ) from error
