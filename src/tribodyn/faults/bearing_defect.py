"""A damaged rolling bearing: its frequencies, and the impacts that a sensor receives."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np

from tribodyn.errors import InputError, require_between, require_one_of, require_positive
from tribodyn.nomenclature import require_whole
from tribodyn.types import Array

Place = Literal["outer", "inner", "element"]


@dataclass(frozen=True, kw_only=True)
class BearingImpacts:
    """Impacts of a local defect of a rolling bearing whose outer ring is at rest.

    Parameters
    ----------
    place : "outer", "inner" or "element"
        Ring or rolling element that has the defect.
    rolling_elements : int
        Number of rolling elements.
    element_diameter, pitch_diameter : float
        Diameters of an element and of the circle of their centres [m].
    contact_angle : float
        Contact angle [rad].
    slip : float
        Standard deviation of the time between two impacts, over its mean [1].

    Raises
    ------
    InputError
        If a value is out of range.

    Notes
    -----
    Impacts with independent random intervals about their mean (Antoni and Randall, J. Vib. Acoust.
    125 (2003) 282). A defect of the inner ring or of an element passes the loaded zone once a turn
    of the ring or of the cage, which modulates its impacts.

    Examples
    --------
    >>> defect = BearingImpacts(place="outer", rolling_elements=9, element_diameter=7.94e-3,
    ...     pitch_diameter=39.04e-3)
    >>> round(defect.frequency(1797 / 60), 2)  # the 6205 of many recordings
    107.36
    """

    place: Place
    rolling_elements: int
    element_diameter: float
    pitch_diameter: float
    contact_angle: float = 0.0
    slip: float = 0.01

    def __post_init__(self) -> None:
        require_one_of("place", self.place, get_args(Place))
        count = require_whole("rolling_elements", self.rolling_elements, 3)
        object.__setattr__(self, "rolling_elements", count)
        for name in ("element_diameter", "pitch_diameter"):
            require_positive(name, getattr(self, name), "m")
        require_between("contact_angle", self.contact_angle, 0.0, 1.2, "rad")
        require_between("slip", self.slip, 0.0, 0.2, "")
        if self.element_diameter >= self.pitch_diameter:
            what = f"element_diameter = {1e3 * self.element_diameter:.4g} mm"
            why = f"The pitch diameter is {1e3 * self.pitch_diameter:.4g} mm"
            raise InputError(
                what, "element_diameter", why, "Elements are smaller than their circle"
            )

    @property
    def _ratio(self) -> float:
        return self.element_diameter / self.pitch_diameter * math.cos(self.contact_angle)

    def frequency(self, shaft: float) -> float:
        """Impacts per second.

        Parameters
        ----------
        shaft : float
            Speed of the shaft in turns per second [Hz].

        Returns
        -------
        float [Hz]
        """
        half = 0.5 * self.rolling_elements * shaft
        return {
            "outer": half * (1.0 - self._ratio),
            "inner": half * (1.0 + self._ratio),
            "element": shaft * self.pitch_diameter / self.element_diameter * (1.0 - self._ratio**2),
        }[self.place]

    def modulation(self, shaft: float) -> float:
        """Frequency with which the defect passes the loaded zone; 0 of an outer ring.

        Parameters
        ----------
        shaft : float
            Speed of the shaft in turns per second [Hz].

        Returns
        -------
        float [Hz]
        """
        cage = 0.5 * shaft * (1.0 - self._ratio)
        return {"outer": 0.0, "inner": shaft, "element": cage}[self.place]

    def superposed(
        self,
        response: Callable[[Array], Array],
        duration: float,
        shaft: float,
        time: Array,
        seed: int = 0,
    ) -> Array:
        """Sum of the responses to all impacts.

        Parameters
        ----------
        response : function
            Response to an impact of full size over the time since it [s].
        duration : float
            Time after which the response has decayed [s].
        shaft : float
            Speed of the shaft in turns per second [Hz].
        time : (n,) array
            Evenly spaced times [s].
        seed : int
            Number of the draw.

        Returns
        -------
        (n,) array
            In the unit of the response.
        """
        mean = 1.0 / self.frequency(shaft)
        rng = np.random.default_rng(seed)
        count = int((time[-1] - time[0] + duration) / mean) + 2
        gaps = mean * np.maximum(1.0 + self.slip * rng.standard_normal(count), 0.1)
        impacts = time[0] - duration + mean * rng.random() + np.cumsum(gaps)
        load = self.modulation(shaft)
        size = (
            np.ones(count) if load == 0.0 else np.maximum(np.cos(2.0 * np.pi * load * impacts), 0)
        )
        step = time[1] - time[0]
        values = np.zeros(time.size)
        for at, strength in zip(impacts, size, strict=True):
            first = max(int(np.ceil((at - time[0]) / step)), 0)
            last = min(int((at + duration - time[0]) / step) + 1, time.size)
            if last > first:
                values[first:last] += strength * response(time[first:last] - at)
        return values


@dataclass(frozen=True, kw_only=True)
class BearingDefect(BearingImpacts):
    """A local defect of a rolling bearing, and how a sensor receives its impacts.

    Parameters
    ----------
    place, rolling_elements, element_diameter, pitch_diameter, contact_angle, slip
        As for :class:`BearingImpacts`.
    acceleration : float
        Largest acceleration of an impact at the sensor [m/s^2].
    resonance : float
        Natural frequency that an impact excites [Hz].
    damping_ratio : float
        Damping of it over the critical one.

    Raises
    ------
    InputError
        If a value is out of range.

    Examples
    --------
    >>> defect = BearingDefect(place="outer", rolling_elements=9, element_diameter=7.94e-3,
    ...     pitch_diameter=39.04e-3, acceleration=5.0, resonance=3000.0)
    >>> defect.resonance
    3000.0
    """

    acceleration: float
    resonance: float
    damping_ratio: float = 0.05

    def __post_init__(self) -> None:
        super().__post_init__()
        require_positive("resonance", self.resonance, "Hz")
        require_between("acceleration", self.acceleration, 0.0, 1e6, "m/s^2")
        require_between("damping_ratio", self.damping_ratio, 1e-4, 0.9, "")

    def signal(self, shaft: float, time: Array, seed: int = 0) -> Array:
        """Acceleration of the impacts.

        Parameters
        ----------
        shaft : float
            Speed of the shaft in turns per second [Hz].
        time : (n,) array
            Evenly spaced times [s].
        seed : int
            Number of the draw.

        Returns
        -------
        (n,) array [m/s^2]
        """
        omega, decay = 2.0 * math.pi * self.resonance, self.damping_ratio
        damped = omega * math.sqrt(1.0 - decay**2)

        def ringing(since: Array) -> Array:
            return np.asarray(np.exp(-decay * omega * since) * np.sin(damped * since))

        duration = math.log(1e4) / (omega * decay)
        return np.asarray(self.acceleration * self.superposed(ringing, duration, shaft, time, seed))


@dataclass(frozen=True, kw_only=True)
class BearingForce(BearingImpacts):
    """A local defect of a rolling bearing, whose impacts press its rings apart.

    Parameters
    ----------
    place, rolling_elements, element_diameter, pitch_diameter, contact_angle, slip
        As for :class:`BearingImpacts`.
    force : float
        Greatest force of an impact, half a sine in time [N].
    duration : float
        Duration of an impact [s].

    Raises
    ------
    InputError
        If a value is out of range.

    Examples
    --------
    >>> BearingForce(place="inner", rolling_elements=9, element_diameter=7.94e-3,
    ...     pitch_diameter=39.04e-3, force=200.0).duration
    0.0001
    """

    force: float
    duration: float = 1e-4

    def __post_init__(self) -> None:
        super().__post_init__()
        require_between("force", self.force, 0.0, 1e7, "N")
        require_between("duration", self.duration, 1e-7, 0.1, "s")
