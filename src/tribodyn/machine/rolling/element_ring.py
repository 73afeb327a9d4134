"""A ring of rolling elements between two rings: load and stiffness of five displacements."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import (
    Argument,
    ComputationError,
    InputError,
    real_numbers,
    warn,
)
from tribodyn.machine.fields import check_number
from tribodyn.types import Array

#: Most steps of the balance, longest step over the element diameter, greatest residual over load.
_STEPS, _STRIDE, _TOLERANCE = 200, 5e-3, 1e-10


class ElementLaw(NamedTuple):
    """Response of all elements to (axial, radial, tilting) displacement of the inner ring."""

    energy: Array  #: elastic energy of each element, (elements,) [J]
    force: Array  #: its gradient, (elements, 3) [N, N, N*m]
    stiffness: Array  #: its second derivative, (elements, 3, 3) [N/m, N, N*m]


@dataclass(frozen=True)
class BearingState:
    """A rolling bearing under load.

    Parameters
    ----------
    displacement : (5,) array [m, rad]
        Of the inner ring against the outer ring: x, y, z, theta_y, theta_z.
    load : (5,) array [N, N*m]
        Force and moment that hold the inner ring there: F_x, F_y, F_z, M_y, M_z.
    stiffness : (5, 5) array
        Derivative of the load with respect to the displacement [N/m, N, N*m].
    element_angle : (elements,) array [rad]
        Position of each rolling element, from y towards z.
    element_load : (elements,) array [N]
        Normal force on each rolling element.
    contact_angle : (elements,) array [rad]
        Contact angle under load, positive where the shaft is held against a motion along +x.
    inner_pressure, outer_pressure : (elements,) array [Pa]
        Greatest Hertzian pressure of each element at the inner and the outer raceway.
    """

    displacement: Array
    load: Array
    stiffness: Array
    element_angle: Array
    element_load: Array
    contact_angle: Array
    inner_pressure: Array
    outer_pressure: Array


@dataclass(frozen=True, kw_only=True)
class RollingElementBearing(ABC):
    """Base of the rolling bearings: dimensions, and the balance of a ring of rolling elements.

    Each element is loaded by the displacement of the inner ring in its own plane: axial
    ``u_a = x``, radial ``u_r = y cos psi + z sin psi`` and the tilt
    ``phi = theta_y sin psi - theta_z cos psi`` about the tangent. The law of the element is that
    of its type; the bearing is the sum over all elements, so that its stiffness is symmetric.

    Parameters
    ----------
    bore_diameter, outer_diameter, width : float, optional [m]
        Main dimensions, from which missing inner ones are estimated.
    pitch_diameter : float, optional [m]
        Diameter of the circle of the element centres; default: mean of bore and outer diameter.
    radial_clearance : float [m]
        Radial play at work, of the diameter; negative for an interference.
    preload : float [N]
        Axial force of the undisplaced bearing.
    direction : int
        1 if the bearing holds the shaft against forces along +x, -1 against those along -x.
    first_element_angle : float [rad]
        Position of the first element, from y towards z.

    Raises
    ------
    InputError
        If a dimension is missing and cannot be estimated, or the dimensions are no bearing.
    """

    bore_diameter: float | None = None
    outer_diameter: float | None = None
    width: float | None = None
    pitch_diameter: float | None = None
    radial_clearance: float = 0.0
    preload: float = 0.0
    direction: int = 1
    first_element_angle: float = 0.0
    #: What was estimated because it was not given.
    assumptions: tuple[str, ...] = field(default=(), init=False, compare=False)

    def __post_init__(self) -> None:
        """Check the dimensions, estimate what is missing, find the position under preload."""
        for name in ("bore_diameter", "outer_diameter", "width"):
            if getattr(self, name) is not None:
                check_number(self, name, "m", 0.0, 10.0, above=True)
        if self.bore_diameter and self.outer_diameter:
            check_number(self, "outer_diameter", "m", 1.05 * self.bore_diameter, 10.0)
        check_number(self, "preload", "N", 0.0, 1e9)
        check_number(self, "first_element_angle", "rad", -1e3, 1e3)
        if self.direction not in (1, -1):
            what, why = f"direction = {self.direction}", "Wanted: 1 or -1, along x or against it"
            raise InputError(what, self._where("direction"), why, "Give one of the two")
        self._estimate(
            "pitch_diameter", lambda bore, outer: 0.5 * (bore + outer), "mean of bore and outside"
        )
        self._complete()
        bore, outer = self.bore_diameter or 0.0, self.outer_diameter or math.inf
        limit = min(outer - self.pitch, self.pitch - bore)
        diameter = self.element_diameter
        if not 0.0 < diameter < limit:
            raise InputError(
                f"rolling elements of {1e3 * diameter:.4g} mm",
                self._where("pitch_diameter"),
                f"Between bore and outside a pitch circle of {1e3 * self.pitch:.4g} mm leaves "
                f"{1e3 * limit:.4g} mm",
                "Correct the diameters",
            )
        most = int(math.pi / math.asin(diameter / self.pitch) + 1e-9)
        if self.elements > most:
            raise InputError(
                f"{self.elements} rolling elements",
                self._where("rollers" if hasattr(self, "rollers") else "balls"),
                f"The pitch circle has space for {most} of {1e3 * diameter:.4g} mm",
                "Correct the number, the diameter of the elements or of the pitch circle",
            )

    def _where(self, name: str) -> Argument:
        return Argument(f"{type(self).__name__}.{name}")

    def _estimate(self, name: str, rule: Callable[[float, float], float], basis: str) -> None:
        """Estimate a dimension that was not given from bore and outer diameter."""
        value = getattr(self, name)
        if value is not None:
            if name in ("balls", "rollers"):
                self._check_count(name, 2)
            else:
                check_number(self, name, "m", 0.0, 10.0, above=True)
            return
        if self.bore_diameter is None or self.outer_diameter is None:
            raise InputError(
                f"{name} is missing",
                self._where(name),
                "It is estimated only where bore_diameter and outer_diameter are given",
                f"Give {name}, or both diameters",
            )
        value = rule(self.bore_diameter, self.outer_diameter)
        text = str(value) if isinstance(value, int) else f"{1e3 * value:.4g} mm"
        object.__setattr__(self, name, value)
        note = f"{name} = {text}, estimated: {basis}"
        object.__setattr__(self, "assumptions", (*self.assumptions, note))

    def _check_count(self, name: str, least: int) -> None:
        """Make a field a whole number of at least ``least``."""
        check_number(self, name, "", least, 1000)
        if not getattr(self, name).is_integer():
            what, why = f"{name} = {getattr(self, name):g}", "Wanted: a whole number"
            raise InputError(what, self._where(name), why, "Count them")
        object.__setattr__(self, name, int(getattr(self, name)))

    @abstractmethod
    def _complete(self) -> None:
        """Check and estimate the dimensions of one type."""

    @property
    @abstractmethod
    def _pressure_limit(self) -> float:
        """Static limit of the pressure after ISO 76 (2006) [Pa]."""

    @property
    @abstractmethod
    def elements(self) -> int:
        """Number of rolling elements."""

    @property
    @abstractmethod
    def element_diameter(self) -> float:
        """Diameter of a rolling element [m]."""

    @abstractmethod
    def element_law(self, axial: Array, radial: Array, tilt: Array) -> ElementLaw:
        """Response of each element to displacements of the inner ring in its plane.

        Parameters
        ----------
        axial, radial, tilt : (elements,) array [m, m, rad]
            Displacements of the inner ring.

        Returns
        -------
        ElementLaw
        """

    @abstractmethod
    def _contacts(self, axial: Array, radial: Array, tilt: Array) -> tuple[Array, ...]:
        """Force, contact angle, inner and outer pressure of each element."""

    @property
    def takes_axial_force(self) -> bool:
        """Whether it holds the shaft along its axis, in one direction at least."""
        return True

    @property
    def pitch(self) -> float:
        """Diameter of the pitch circle [m]."""
        return float(self.pitch_diameter or 0.0)

    @cached_property
    def element_angles(self) -> Array:
        """Positions of the rolling elements, from y towards z [rad]."""
        return self.first_element_angle + 2.0 * np.pi * np.arange(self.elements) / self.elements

    @cached_property
    def _to_element(self) -> Array:
        """Displacement in the plane of each element of the five displacements."""
        cosine, sine = np.cos(self.element_angles), np.sin(self.element_angles)
        rows = np.zeros((self.elements, 3, 5))
        rows[:, 0, 0], rows[:, 1, 1], rows[:, 1, 2] = 1.0, cosine, sine
        rows[:, 2, 3], rows[:, 2, 4] = sine, -cosine
        return rows

    @cached_property
    def axial_offset(self) -> float:
        """Axial displacement of the inner ring that the preload makes, along x [m].

        Raises
        ------
        InputError
            If the bearing cannot carry the preload.
        """
        if not self.preload:
            return 0.0
        from scipy.optimize import brentq

        def excess(offset: float) -> float:
            none = np.zeros(self.elements)
            law = self.element_law(none + self.direction * offset, none, none)
            return float(self.direction * law.force[:, 0].sum() - self.preload)

        high = 1e-3 * self.element_diameter
        low = 0.0 if excess(0.0) < 0.0 else -self.element_diameter  # an interference presses too
        while excess(high) < 0.0:
            high *= 2.0
            if high > 0.5 * self.element_diameter:
                raise InputError(
                    f"preload = {self.preload:.6g} N",
                    self._where("preload"),
                    "The bearing cannot carry it along its axis",
                    "Give a force of the order of the load rating in N, or none",
                )
        return self.direction * float(brentq(excess, low, high, xtol=1e-18, rtol=1e-14))

    def _local(self, displacement: Array) -> tuple[Array, Array, Array]:
        axial, radial, tilt = np.moveaxis(self._to_element @ displacement, -1, 0)
        return axial + self.axial_offset, radial, tilt

    def response(self, displacement: Array) -> tuple[float, Array, Array]:
        """Elastic energy, load and stiffness at a displacement of the inner ring.

        Parameters
        ----------
        displacement : (5,) array [m, rad]
            Of the inner ring against the outer ring: x, y, z, theta_y, theta_z.

        Returns
        -------
        tuple
            Energy [J], load (5,) [N, N*m], stiffness (5, 5) [N/m, N, N*m].
        """
        law, rows = self.element_law(*self._local(displacement)), self._to_element
        load = np.einsum("eij,ei->j", rows, law.force)
        stiffness = np.einsum("eij,eik,ekl->jl", rows, law.stiffness, rows)
        return float(law.energy.sum()), load, 0.5 * (stiffness + stiffness.T)

    def load(self, displacement: ArrayLike) -> Array:
        """Force and moment that hold the inner ring at a displacement.

        Parameters
        ----------
        displacement : (5,) array [m, rad]
            x, y, z, theta_y, theta_z of the inner ring against the outer ring.

        Returns
        -------
        (5,) array [N, N*m]
            F_x, F_y, F_z, M_y, M_z.
        """
        return self.response(_five("displacement", displacement))[1]

    def stiffness(self, displacement: ArrayLike) -> Array:
        """Derivative of the load with respect to the displacement.

        Parameters
        ----------
        displacement : (5,) array [m, rad]
            x, y, z, theta_y, theta_z of the inner ring against the outer ring.

        Returns
        -------
        (5, 5) array [N/m, N, N*m]
            Symmetric.
        """
        return self.response(_five("displacement", displacement))[2]

    def displacement(self, load: ArrayLike) -> Array:
        """Displacement of the inner ring under a load.

        Parameters
        ----------
        load : (5,) array [N, N*m]
            F_x, F_y, F_z, M_y, M_z on the inner ring.

        Returns
        -------
        (5,) array [m, rad]
            x, y, z, theta_y, theta_z. Where nothing holds the ring (inside of a clearance), the
            position is one of many that balance the load.

        Raises
        ------
        ComputationError
            If no displacement balances the load.
        """
        target = _five("load", load)
        scale = np.array([1.0, 1.0, 1.0, 2.0 / self.pitch, 2.0 / self.pitch])
        stride, position, shift = _STRIDE * self.element_diameter, np.zeros(5), 0.0
        limit = _TOLERANCE * np.abs(target * scale).max() + 1e-9
        energy, force, stiffness = self.response(position)
        for _ in range(_STEPS):
            residual = (target - force) * scale
            if np.abs(residual).max() <= limit:
                return position
            matrix = scale[:, None] * stiffness * scale
            shift = max(shift, 1e-12 * float(np.trace(matrix)), 1e-3)
            for _ in range(60):
                step = np.linalg.solve(matrix + shift * np.eye(5), residual)
                length = float(np.linalg.norm(step))
                if length > stride:
                    step *= stride / length
                trial = position + scale * step
                new = self.response(trial)
                # The potential is convex: each step lowers it, up to rounding.
                gain = energy - new[0] + float(target @ (trial - position))
                if gain >= -1e-13 * abs(energy) - 1e-15:
                    break
                shift = max(10.0 * shift, 1e-6 * float(np.trace(matrix)))
            position, (energy, force, stiffness), shift = trial, new, 0.1 * shift
        raise ComputationError(
            f"no displacement of the bearing balances the load {_format(target)} N, N*m; "
            f"{_format(target - force)} is left after {_STEPS} steps",
            Argument("load"),
            self._limits(),
            "Correct the load, or give another type of bearing",
        )

    def _limits(self) -> str:
        """Loads that the type cannot carry."""
        return "The load exceeds what the contacts can carry"

    def state(self, displacement: ArrayLike) -> BearingState:
        """Loads and pressures of all elements at a displacement of the inner ring.

        Parameters
        ----------
        displacement : (5,) array [m, rad]
            x, y, z, theta_y, theta_z of the inner ring against the outer ring.

        Returns
        -------
        BearingState
        """
        position = _five("displacement", displacement)
        _, load, stiffness = self.response(position)
        contacts = self._contacts(*self._local(position))
        if (pressure := float(np.max(contacts[2:]))) > self._pressure_limit:
            warn(
                "bearing-pressure",
                f"the pressure on the rolling elements reaches {1e-6 * pressure:.0f} MPa, above "
                f"the {1e-6 * self._pressure_limit:.0f} MPa of ISO 76 that dent the raceways: "
                "choose a larger bearing, or correct the load",
            )
        return BearingState(position, load, stiffness, self.element_angles, *contacts)


def _five(name: str, values: ArrayLike) -> Array:
    """Read five finite numbers."""
    array = real_numbers(Argument(name), values)
    if array.shape != (5,) or not np.isfinite(array).all():
        what = f"{name} has the shape {array.shape}" if array.shape != (5,) else f"{name} = {array}"
        raise InputError(
            what,
            Argument(name),
            "Wanted: five finite numbers, of x, y, z, theta_y and theta_z",
            "The shaft turns freely about x, which has no entry",
        )
    return array


def _format(values: Array) -> str:
    return f"({', '.join(f'{value:.4g}' for value in values)})"
