"""A measured roughness profile: a column of heights, on either surface of a contact."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from os import PathLike
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import Argument, InputError, require_one_of, require_positive, warn
from tribodyn.types import Array
from tribodyn.units import convert
from tribodyn.validated_files import plain_number, read_bytes

#: Points of a sinusoidal wave.
_WAVE_POINTS = 64
#: Treatment of positions beyond the ends of a profile.
BEYOND = ("refuse", "periodic", "level")


@dataclass(frozen=True, eq=False)
class RoughnessProfile:
    """Heights of a surface along the direction of rolling.

    A profile is a function: called with positions, it returns the heights that it adds to the
    gap, which a peak of the surface makes smaller.

    Parameters
    ----------
    position : (n,) array [m]
        Equally spaced, rising; position zero lies in the centre of the contact at time zero.
    height : (n,) array [m]
        Height of the surface above its mean line, positive out of the material.
    beyond : {"refuse", "periodic", "level"}
        What lies beyond the ends: nothing is known, the profile again, or the mean line.

    Raises
    ------
    InputError
        If there are fewer than 8 heights, one is not finite, the positions are not equally
        spaced, or ``beyond`` is unknown.

    Examples
    --------
    >>> import numpy as np
    >>> x = np.linspace(-1e-3, 1e-3, 401)
    >>> profile = RoughnessProfile(x, 1e-7 * np.sin(2 * np.pi * x / 1e-4))
    >>> round(profile.rms * 1e6, 4), round(profile.mean_roughness * 1e6, 4)
    (0.0706, 0.063)
    >>> float(np.round(profile(0.25e-4), 12))
    -1e-07
    """

    position: Array = field(repr=False)
    height: Array = field(repr=False)
    beyond: Literal["refuse", "periodic", "level"] = "refuse"

    def __post_init__(self) -> None:
        """Check the columns."""
        position = np.array(self.position, dtype=float).reshape(-1)
        height = np.array(self.height, dtype=float).reshape(-1)
        object.__setattr__(self, "position", position)
        object.__setattr__(self, "height", height)
        require_one_of("beyond", self.beyond, BEYOND)
        if height.size < 8 or position.size != height.size:
            what = f"{height.size} heights and {position.size} positions"
            why = "a profile needs at least 8 heights, each with its position"
            remedy = "Measure more points, and give one position for each height"
            raise InputError(what, "argument height", why, remedy)
        bad = np.flatnonzero(~np.isfinite(height))
        if bad.size:
            why = "every height must be a finite number of metres"
            remedy = "Cut out the points that the instrument could not measure"
            raise InputError(f"height[{bad[0]}] = {height[bad[0]]}", "argument height", why, remedy)
        steps = np.diff(position)
        spacing = (position[-1] - position[0]) / (position.size - 1)
        if not spacing > 0.0 or np.max(np.abs(steps - spacing)) > 1e-3 * spacing:
            raise InputError(
                f"steps of {steps.min():.6g} to {steps.max():.6g} m between positions",
                where="argument position",
                why="positions must rise in equal steps",
                remedy="Interpolate the profile, or give heights and their spacing to "
                "RoughnessProfile.from_heights",
            )

    @classmethod
    def from_heights(
        cls,
        spacing: float,
        heights: ArrayLike,
        *,
        remove_tilt: bool = True,
        start: float | None = None,
        beyond: Literal["refuse", "periodic", "level"] = "refuse",
    ) -> RoughnessProfile:
        """Profile of a column of heights, as an instrument writes them.

        Parameters
        ----------
        spacing : float [m]
            Distance of neighbouring points.
        heights : array [m]
            Heights in the order in which they enter the contact last to first: downstream rises.
        remove_tilt : bool
            Whether to take away the straight line of least squares; else the mean alone.
        start : float, optional [m]
            Position of the first height at time zero; by default the profile is centred.
        beyond : {"refuse", "periodic", "level"}
            What lies beyond the ends.

        Raises
        ------
        InputError
            If the spacing is not positive, or the heights are no profile.

        Examples
        --------
        >>> profile = RoughnessProfile.from_heights(1e-6, [0, 1e-7, 0, 1e-7, 0, 1e-7, 0, 1e-7])
        >>> round(profile.length * 1e6, 6)
        7.0
        """
        require_positive("spacing", spacing, "m", remedy="1 um is 1e-6 m")
        height = np.asarray(heights, dtype=float).reshape(-1)
        index = np.arange(height.size)
        if height.size >= 8 and np.all(np.isfinite(height)):
            line = np.polyfit(index, height, 1) if remove_tilt else [0.0, float(np.mean(height))]
            height = np.asarray(height - np.polyval(line, index), dtype=float)
        first = -0.5 * spacing * (height.size - 1) if start is None else start
        return cls(np.asarray(first + spacing * index, dtype=float), height, beyond)

    @classmethod
    def wave(cls, amplitude: float, wavelength: float, phase: float = 0.0) -> RoughnessProfile:
        """Periodic profile of sinusoidal waves.

        Parameters
        ----------
        amplitude : float [m]
            Half of the height from trough to crest.
        wavelength : float [m]
            Length of a wave.
        phase : float [rad]
            Height at position zero is the amplitude times the sine of the phase.

        Raises
        ------
        InputError
            If the amplitude or the wavelength is not positive.

        Examples
        --------
        >>> wave = RoughnessProfile.wave(1e-7, 5e-5)
        >>> round(wave.rms * 1e7, 4), float((wave(1.25e-5) * 1e7).round(6))
        (0.7071, -1.0)
        """
        require_positive("amplitude", amplitude, "m")
        require_positive("wavelength", wavelength, "m")
        part = np.arange(_WAVE_POINTS) / _WAVE_POINTS
        heights = amplitude * np.sin(2.0 * np.pi * part + phase)
        return cls(wavelength * part, heights, "periodic")

    @classmethod
    def read(cls, path: str | PathLike[str]) -> RoughnessProfile:
        """Profile of a text file with the columns position and height.

        Parameters
        ----------
        path : str or path
            CSV file: the first row names the columns, the second has their units, for example
            ``mm,um``; each further row is one point. The straight line of least squares is taken
            away.

        Raises
        ------
        InputError
            If there is no such file, or its rows are no profile; the message names the line.
        """
        try:
            text = read_bytes(path, "profile map").decode("utf-8-sig")
        except (OSError, UnicodeDecodeError) as error:
            reason = getattr(error, "strerror", None) or "it is not UTF-8 text"
            raise _fault(path, 0, f"the file cannot be read: {reason}") from None
        lines = [(n, line.strip()) for n, line in enumerate(text.splitlines(), 1) if line.strip()]
        rows = [(n, re.split(r"[;,\t]", line)) for n, line in lines if not line.startswith("#")]
        if len(rows) < 2 or [name.strip() for name in rows[0][1]] != ["position", "height"]:
            raise _fault(path, rows[0][0] if rows else 0, "the columns are not position and height")
        try:
            factors = [convert(1.0, unit.strip(), "m") for unit in rows[1][1]]
        except ValueError as error:
            raise _fault(path, rows[1][0], str(error)) from None
        points = []
        for number, cells in rows[2:]:
            values = [plain_number(cell.strip()) for cell in cells]
            if len(values) != 2 or len(factors) != 2 or None in values:
                raise _fault(
                    path, number, f'"{",".join(cells)[:40]}" is not a position and a height'
                )
            points.append([v * f for v, f in zip(values, factors, strict=True) if v is not None])
        position, height = np.array(points).reshape(-1, 2).T
        return cls.from_heights(cls(position, height).spacing, height)

    @property
    def spacing(self) -> float:
        """Distance of neighbouring points [m]."""
        return float((self.position[-1] - self.position[0]) / (self.position.size - 1))

    @property
    def length(self) -> float:
        """Distance of the first from the last point [m]."""
        return float(self.position[-1] - self.position[0])

    @property
    def rms(self) -> float:
        """Root of the mean square of the heights about their mean, R_q [m]."""
        return float(np.std(self.height))

    @property
    def mean_roughness(self) -> float:
        """Mean absolute height about the mean, R_a [m]."""
        return float(np.mean(np.abs(self.height - np.mean(self.height))))

    def spectral_moments(self) -> tuple[float, float, float]:
        """Mean squares of height, slope and curvature.

        Returns
        -------
        tuple of float [m^2], [-], [1/m^2]
            m0, m2 and m4, by central differences of neighbouring points: they are those of the
            sampling, and rise as it gets finer.

        Source: McCool, Wear 107 (1986).

        Examples
        --------
        >>> x = np.linspace(0.0, 1e-3, 2001)
        >>> wave = RoughnessProfile(x, 1e-7 * np.sin(2 * np.pi * x / 1e-4))
        >>> print(" ".join(f"{moment:.3g}" for moment in wave.spectral_moments()))
        5e-15 1.97e-05 7.8e+04
        """
        height, step = self.height, self.spacing
        if self.beyond == "periodic":
            height = np.concatenate([height[-1:], height, height[:1]])
        slope = (height[2:] - height[:-2]) / (2.0 * step)
        curvature = (height[2:] - 2.0 * height[1:-1] + height[:-2]) / step**2
        return self.rms**2, float(np.mean(slope**2)), float(np.mean(curvature**2))

    def filtered(self, cutoff: float) -> RoughnessProfile:
        """Profile without the wavelengths below a cutoff.

        Parameters
        ----------
        cutoff : float [m]
            Wavelength of which half of the amplitude is left.

        Returns
        -------
        RoughnessProfile
            Over the same positions. Within half a cutoff of the ends of a profile that is not
            periodic the mean takes in fewer points.

        Raises
        ------
        InputError
            If the cutoff is not positive.

        Source: Gaussian filter of ISO 16610-21.
        """
        require_positive("cutoff", cutoff, "m")
        alpha = np.sqrt(np.log(2.0) / np.pi)
        reach = int(np.ceil(cutoff / self.spacing))
        offset = np.arange(-reach, reach + 1) * self.spacing
        weight = np.exp(-np.pi * (offset / (alpha * cutoff)) ** 2)
        if self.beyond == "periodic":
            padded = np.take(self.height, np.arange(-reach, self.height.size + reach), mode="wrap")
            smooth = np.convolve(padded, weight / weight.sum(), mode="valid")
        else:
            share = np.convolve(np.ones_like(self.height), weight, mode="same")
            smooth = np.convolve(self.height, weight, mode="same") / share
        return RoughnessProfile(self.position, smooth, self.beyond)

    def short_wave_share(self, wavelength: float) -> float:
        """Share of the mean square height in waves shorter than a given one.

        Parameters
        ----------
        wavelength : float [m]
            The limit.

        Returns
        -------
        float
            Between 0 and 1.
        """
        window = (
            np.ones(self.height.size) if self.beyond == "periodic" else np.hanning(self.height.size)
        )
        power = np.abs(np.fft.rfft((self.height - np.mean(self.height)) * window)) ** 2
        wave_number = np.fft.rfftfreq(self.height.size, self.spacing)
        total = float(power[1:].sum())
        return float(power[wave_number * wavelength > 1.0].sum()) / total if total > 0.0 else 0.0

    def __call__(self, position: ArrayLike) -> Array:
        """Heights that the profile adds to the gap.

        Parameters
        ----------
        position : float or array [m]
            Where.

        Returns
        -------
        array [m]
            Minus the height of the surface, cubic between the points.

        Raises
        ------
        InputError
            If a position lies beyond the ends of a profile that ends.
        """
        place = np.asarray(position, dtype=float)
        self.require_range(float(np.min(place)), float(np.max(place)))
        q = (place - self.position[0]) / self.spacing
        size = self.height.size
        floor = np.floor(q).astype(int)
        inside = np.ones(np.shape(q), dtype=bool)
        if self.beyond != "periodic":
            inside = (q >= 0.0) & (q <= size - 1.0)
            floor = np.clip(floor, 1, size - 3)
        f = q - floor
        a, b, c, d = (self.height[(floor + shift) % size] for shift in (-1, 0, 1, 2))
        value = b * (f + 1.0) * (f - 1.0) * (f - 2.0) / 2.0 - c * (f + 1.0) * f * (f - 2.0) / 2.0
        value += d * (f + 1.0) * f * (f - 1.0) / 6.0 - a * f * (f - 1.0) * (f - 2.0) / 6.0
        return np.where(inside, -value, 0.0)

    def require_range(self, first: float, last: float) -> None:
        """Refuse positions that the profile does not cover.

        Parameters
        ----------
        first, last : float [m]
            Range that is needed.

        Raises
        ------
        InputError
            If a part of it lies beyond the ends of a profile that ends.
        """
        tolerance = 1e-9 * self.spacing
        covered = first >= self.position[0] - tolerance and last <= self.position[-1] + tolerance
        if self.beyond == "refuse" and not covered:
            raise InputError(
                f"heights are needed from {first * 1e3:.6g} to {last * 1e3:.6g} mm",
                where="roughness profile",
                why=f"it was measured from {self.position[0] * 1e3:.6g} to "
                f"{self.position[-1] * 1e3:.6g} mm",
                remedy="Measure a longer profile, shift it by its start, or choose beyond = "
                '"periodic" or "level"',
            )


def _fault(path: str | PathLike[str], line: int, what: str) -> InputError:
    place = f"{Path(path).name}, line {line}" if line else Path(path).name
    why = "A profile has the columns position and height, their units below, for example mm,um"
    remedy = "Give a profile, or the path of a file with the columns position and height"
    return InputError(f"{what} ({place})", Argument("roughness_profile"), why, remedy)


#: Grid points that a wavelength needs, and the share of the mean square that may lie below.
_POINTS, _SHARE = 16, 0.02


def warn_if_unresolved(profile: RoughnessProfile, spacing: float, stacklevel: int = 2) -> None:
    """Warn where a grid does not resolve the waves of a profile."""
    shortest = _POINTS * spacing
    share = profile.short_wave_share(shortest)
    if share > _SHARE:
        warn(
            "roughness-resolution",
            f"{share:.1%} of the mean square roughness lies in waves shorter than "
            f"{shortest * 1e6:.3g} um, which have fewer than {_POINTS} nodes a wavelength at a "
            f"spacing of {spacing * 1e6:.3g} um. Use more nodes, or profile.filtered("
            f"{shortest:.2g})",
            stacklevel=stacklevel + 1,
        )
