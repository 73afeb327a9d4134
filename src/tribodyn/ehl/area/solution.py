"""Solved contacts over an area, points, ellipses and lines of finite length; their friction."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from tribodyn.contact.hertz import dry_half_width
from tribodyn.ehl.traction.film_temperature import (
    STEEL_THERMAL_CONTACT_COEFFICIENT,
    film_temperature_rise,
    film_thermal_resistance,
    thermal_oil,
)
from tribodyn.ehl.traction.shear_models import EYRING_STRESS, SHEAR_MODELS
from tribodyn.ehl.traction.traction import FilmShear, FilmState
from tribodyn.errors import require_between
from tribodyn.lubricant import Lubricant
from tribodyn.record import Record, fact, quantity, record
from tribodyn.types import Array

#: Least film that is sheared, over the central one.
_THINNEST = 0.01


@record
class AreaFriction(Record):
    """Friction of a contact over an area.

    Parameters
    ----------
    coefficient : float [-]
        Friction force over the normal force.
    force : float [N]
        Friction force, not negative.
    position : (lines,) array [m]
        Position of each line, across the entrainment.
    force_per_width : (lines,) array [N/m]
        Friction force of each line.
    temperature_rise : (lines,) array [K]
        Rise of the mean film temperature of each line above the inlet; zero without heating.
    mean_temperature_rise : float [K]
        Its mean, weighted with the heat of the lines.
    """

    coefficient: float = fact()
    force: float = fact()
    position: Array = quantity("position", unit="m", axis=True)
    force_per_width: Array = quantity("position", unit="N/m")
    temperature_rise: Array = quantity("position", unit="K")
    mean_temperature_rise: float = fact()


def area_friction(
    solution: Any,
    sliding_speed: float,
    shear_model: str,
    eyring_stress: float,
    flash_temperature: bool,
    bodies: tuple[float, float],
    oil: Mapping[str, float | None],
) -> AreaFriction:
    """See :meth:`tribodyn.ehl.PointContactSolution.friction`."""
    require_between("sliding_speed", sliding_speed, -math.inf, math.inf, "m/s")
    angle = solution.entrainment_angle
    along_y = abs(math.sin(angle)) > abs(math.cos(angle))
    axis, across = (solution.y, solution.x) if along_y else (solution.x, solution.y)
    turned = np.transpose if along_y else np.asarray
    pressure, film = turned(solution.pressure), turned(solution.film)
    # Where the grid does not resolve the film at the end of a roller.
    film = np.maximum(film, _THINNEST * solution.central_film)
    loaded = np.flatnonzero((pressure > 0.0).any(axis=1) & (solution.line_half_width > 0.0))
    state = FilmState(
        np.broadcast_to(axis, (loaded.size, axis.size)),
        pressure[loaded],
        film[loaded],
        solution.lubricant,
        solution.effective_modulus,
        viscosity_law=solution.viscosity_law,
    )
    model = SHEAR_MODELS[shear_model]
    shear = FilmShear(state, model, model.complete(eyring_stress, dict(oil)))
    speed = np.full(loaded.size, abs(float(sliding_speed)))
    rise = np.zeros(loaded.size)
    if flash_temperature:
        half = 0.5 * speed
        resistance = film_thermal_resistance(
            solution.line_half_width[loaded], state.central_film,
            solution.entrainment_speed + half, solution.entrainment_speed - half,
            thermal_oil(solution.lubricant).thermal_conductivity, bodies,
        )  # fmt: skip

        def heat(warmer: Array) -> tuple[Array, Array]:
            """Heat of the lines, and its slope over their temperature."""
            force, slope = shear.sliding(speed, warmer)
            return speed * force, speed * slope

        rise = film_temperature_rise(heat, resistance)
    lines, _ = shear.sliding(speed, rise if flash_temperature else None)
    force_per_width, temperature_rise = np.zeros(across.size), np.zeros(across.size)
    force_per_width[loaded], temperature_rise[loaded] = lines, rise
    force = float(force_per_width.sum() * (across[1] - across[0]))
    total = float(lines.sum())
    return AreaFriction(
        coefficient=force / solution.normal_force,
        force=force,
        position=across,
        force_per_width=force_per_width,
        temperature_rise=temperature_rise,
        mean_temperature_rise=float(lines @ rise) / total if total > 0.0 else 0.0,
    )


@record
class PointContactSolution(Record):
    """Pressure and film of a lubricated point or elliptical contact, steady and isothermal.

    Parameters
    ----------
    x, y : (nx,), (ny,) arrays [m]
        Positions along both principal axes of the gap, from its middle.
    pressure : (ny, nx) array [Pa]
        Pressure above ambient.
    film : (ny, nx) array [m]
        Gap between the bodies.
    central_film, minimum_film : float [m]
        Film in the middle, and least film where the oil carries pressure.
    central_film_error : float [m]
        Estimate of the error of ``central_film`` by the grid, from one half as fine.
    central_film_extrapolated : float [m]
        Central film extrapolated to an infinitely fine grid.
    hertz_pressure, semi_axis_x, semi_axis_y, hertz_approach : float [Pa], [m], [m], [m]
        Greatest pressure, half axes and approach of the dry contact.
    maximum_pressure : float [Pa]
        Greatest pressure of the oil; a spike is not converged on uniform grids.
    approach : float [m]
        By how much distant points of both bodies come nearer: that of the dry contact, less what
        the film lifts.
    moes_load, moes_viscosity : float [-]
        Numbers M and L of Moes, with the radius along the entrainment.
    ellipticity : float [-]
        Half axis along y over that along x.
    outside_load : float [N]
        Part of the normal force that the oil outside the grid carries, in the far inlet.
    load_error : float [-]
        Relative difference between the normal force and the integral of the pressure over the
        grid with ``outside_load``.
    residual : float [-]
        Mean imbalance of the flow where there is pressure, over the mean change of the flow that
        is carried along.
    cycles, nodes_x, nodes_y : int
        Multigrid cycles on the finest grid, and its nodes.
    attempts : tuple of str
        What was tried in vain before.
    normal_force : float [N]
        Argument of :func:`tribodyn.ehl.solve_point_contact`, as the following.
    radius_x, radius_y : float [m]
    entrainment_speed : float [m/s]
    entrainment_angle : float [rad]
    effective_modulus : float [Pa]
    lubricant, viscosity_law, compressible
        As there; the law that was used.
    """

    x: Array = quantity("x", unit="m", axis=True)
    y: Array = quantity("y", unit="m", axis=True)
    pressure: Array = quantity("y", "x", unit="Pa")
    film: Array = quantity("y", "x", unit="m")
    central_film: float = fact()
    minimum_film: float = fact()
    central_film_error: float = fact()
    central_film_extrapolated: float = fact()
    hertz_pressure: float = fact()
    semi_axis_x: float = fact()
    semi_axis_y: float = fact()
    hertz_approach: float = fact()
    maximum_pressure: float = fact()
    approach: float = fact()
    moes_load: float = fact()
    moes_viscosity: float = fact()
    ellipticity: float = fact()
    outside_load: float = fact()
    load_error: float = fact()
    residual: float = fact()
    cycles: int = fact()
    nodes_x: int = fact()
    nodes_y: int = fact()
    attempts: tuple[str, ...]
    normal_force: float = fact()
    radius_x: float = fact()
    radius_y: float = fact()
    entrainment_speed: float = fact()
    entrainment_angle: float = fact()
    effective_modulus: float = fact()
    lubricant: Lubricant
    viscosity_law: str = fact()
    compressible: bool = fact()

    @property
    def line_half_width(self) -> Array:
        """Half width of the dry contact at every position across the entrainment [m]."""
        across, half, side = self.y, self.semi_axis_x, self.semi_axis_y
        if abs(np.sin(self.entrainment_angle)) > abs(np.cos(self.entrainment_angle)):
            across, half, side = self.x, self.semi_axis_y, self.semi_axis_x
        return np.asarray(half * np.sqrt(np.maximum(1.0 - (across / side) ** 2, 0.0)))

    def friction(
        self,
        sliding_speed: float,
        *,
        shear_model: str = "ree-eyring",
        eyring_stress: float = EYRING_STRESS,
        flash_temperature: bool = False,
        bodies: tuple[float, float] = (STEEL_THERMAL_CONTACT_COEFFICIENT,) * 2,
        **oil: float | None,
    ) -> AreaFriction:
        """Friction of the sheared film.

        Parameters
        ----------
        sliding_speed : float [m/s]
            Difference of the surface speeds, along the entrainment.
        shear_model : str
            How the oil shears: a name of :data:`tribodyn.ehl.SHEAR_MODELS`.
        eyring_stress : float [Pa]
            Stress from which an oil thins, by the models that have it.
        flash_temperature : bool
            Take the viscosity of every line along the entrainment at its mean temperature: inlet
            plus mean flash temperature of Blok plus the rise across the oil.
        bodies : (float, float) [J/(m^2 K s^0.5)]
            ``sqrt(k rho c)`` of each body; gear steel by default.
        **oil : float
            Other numbers of the shear model, such as ``limiting_stress`` [Pa].

        Returns
        -------
        AreaFriction
            Coefficient, force and temperature rise.

        Raises
        ------
        InputError
            If a value is out of range, or the oil lacks the thermal data that are needed.

        The film is that of a Newtonian oil at the temperature of the inlet. Source: Johnson and
        Tevaarwerk (1977); Blok (1963).
        """
        return area_friction(
            self, sliding_speed, shear_model, eyring_stress, flash_temperature, bodies, oil
        )

    def __repr__(self) -> str:
        """One line with the figures that tell contacts apart."""
        spread = self.central_film_error / self.central_film
        return (
            f"PointContactSolution(central film {self.central_film * 1e6:.4f} um +- {spread:.1g} "
            f"of it, minimum {self.minimum_film * 1e6:.4f} um, Hertz pressure "
            f"{self.hertz_pressure * 1e-9:.4f} GPa over {self.semi_axis_x * 1e3:.4g} mm by "
            f"{self.semi_axis_y * 1e3:.4g} mm half axes, M {self.moes_load:.4g}, "
            f"L {self.moes_viscosity:.4g}, {self.nodes_x} x {self.nodes_y} nodes, "
            f"{self.cycles} cycles)"
        )


#: Deviations of film and pressure from the infinite line up to which it is enough.
FILM_LIMIT, PRESSURE_LIMIT = 0.02, 0.05
#: Part of the length at each end that counts as end.
_END = 0.15


@record
class FiniteLineSolution(Record):
    """Pressure and film of a lubricated roller of finite length, steady and isothermal.

    Parameters
    ----------
    x, y : (nx,), (ny,) arrays [m]
        Positions in the direction of rolling and along the roller, from its middle.
    pressure : (ny, nx) array [Pa]
        Pressure above ambient.
    film : (ny, nx) array [m]
        Gap between the bodies.
    load_per_length : (ny,) array [N/m]
        Load along the roller.
    central_film, central_film_error, central_film_extrapolated : float [m]
        Film in the middle of the roller, its error by the grid, and its extrapolation.
    minimum_film, maximum_pressure : float [m], [Pa]
        Least film with pressure, and greatest pressure, anywhere.
    line_central_film, line_minimum_film, line_maximum_pressure : float [m], [m], [Pa]
        Those of the infinite line under the load per length of the middle.
    hertz_pressure, half_width : float [Pa], [m]
        Those of the dry infinite line under the mean load per length.
    moes_load, moes_viscosity : float [-]
        Numbers M and L of Moes of that line.
    outside_load : float [N]
        As for :class:`tribodyn.ehl.PointContactSolution`, as the following.
    load_error, residual : float [1]
    cycles, nodes_x, nodes_y : int
    attempts : tuple of str
    profile : str
        Shape of the roller.
    normal_force : float [N]
        Argument of :func:`tribodyn.ehl.solve_finite_line_contact`, as the following.
    length, equivalent_radius : float [m]
    entrainment_speed : float [m/s]
    effective_modulus : float [Pa]
    lubricant, viscosity_law, compressible
        As there.
    """

    x: Array = quantity("x", unit="m", axis=True)
    y: Array = quantity("y", unit="m", axis=True)
    pressure: Array = quantity("y", "x", unit="Pa")
    film: Array = quantity("y", "x", unit="m")
    load_per_length: Array = quantity("y", unit="N/m")
    central_film: float = fact()
    central_film_error: float = fact()
    central_film_extrapolated: float = fact()
    minimum_film: float = fact()
    maximum_pressure: float = fact()
    line_central_film: float = fact()
    line_minimum_film: float = fact()
    line_maximum_pressure: float = fact()
    hertz_pressure: float = fact()
    half_width: float = fact()
    moes_load: float = fact()
    moes_viscosity: float = fact()
    outside_load: float = fact()
    load_error: float = fact()
    residual: float = fact()
    cycles: int = fact()
    nodes_x: int = fact()
    nodes_y: int = fact()
    attempts: tuple[str, ...]
    profile: str = fact()
    normal_force: float = fact()
    length: float = fact()
    equivalent_radius: float = fact()
    entrainment_speed: float = fact()
    effective_modulus: float = fact()
    lubricant: Lubricant
    viscosity_law: str = fact()
    compressible: bool = fact()

    friction = PointContactSolution.friction
    #: Entrainment runs along x.
    entrainment_angle = 0.0

    @property
    def line_half_width(self) -> Array:
        """Half width of a dry line under the local load, along the roller [m]."""
        width = dry_half_width(self.load_per_length, self.equivalent_radius, self.effective_modulus)
        return np.asarray(np.where(self.load_per_length > 0.0, width, 0.0))

    @property
    def ridge_pressure(self) -> Array:
        """Greatest pressure at each position along the roller [Pa]."""
        return np.asarray(self.pressure.max(axis=1))

    @property
    def ridge_film(self) -> Array:
        """Least film with pressure at each position along the roller [m]; NaN without pressure."""
        loaded = np.where(self.pressure > 0.0, self.film, np.inf).min(axis=1)
        return np.where(np.isfinite(loaded), loaded, np.nan)

    @property
    def _at_ends(self) -> Array:
        loaded = self.pressure.max(axis=1) > 0.0
        return np.asarray((np.abs(self.y) > (0.5 - _END) * self.length) & loaded)

    @property
    def edge_pressure_ratio(self) -> float:
        """Greatest pressure in the last 15 % of the length at each end, over that in the middle."""
        ridge = self.ridge_pressure
        return float(ridge[self._at_ends].max(initial=0.0) / ridge[self.y.size // 2])

    @property
    def end_film(self) -> float:
        """Least film in the last 15 % of the length at each end [m]."""
        return float(np.nanmin(self.ridge_film[self._at_ends], initial=np.inf))

    @property
    def line_deviation(self) -> float:
        """Relative difference of the film at mid length from that of the infinite line."""
        return self.central_film_extrapolated / self.line_central_film - 1.0

    @property
    def line_is_enough(self) -> bool:
        """Whether the infinite line under the mean load describes the roller to a few per cent."""
        return not self._reasons()

    def _reasons(self) -> list[str]:
        """Why the infinite line is not enough."""
        middle = float(self.load_per_length[self.y.size // 2])
        spread = middle * self.length / self.normal_force - 1.0
        reasons = []
        if abs(self.line_deviation) > FILM_LIMIT:
            reasons.append(f"the film at mid length differs by {self.line_deviation:.1%}")
        if abs(spread) > PRESSURE_LIMIT:
            reasons.append(
                f"the load per length at mid length differs by {spread:.1%} from its mean"
            )
        if self.edge_pressure_ratio > 1.0 + PRESSURE_LIMIT:
            reasons.append(f"the ends carry {self.edge_pressure_ratio:.2f} times the pressure")
        thinner = self.minimum_film / self.line_minimum_film - 1.0
        if thinner < -PRESSURE_LIMIT:
            reasons.append(f"the least film is {-thinner:.0%} thinner than that of the line")
        return reasons

    def compare_with_line(self) -> str:
        """Sentence that says whether the infinite line is enough, with figures."""
        reasons = self._reasons()
        if not reasons:
            return (
                f"The infinite line is enough: film at mid length {self.line_deviation:+.1%}, "
                f"pressure at the ends {self.edge_pressure_ratio:.2f} times that in the middle"
            )
        return f"The infinite line is not enough: {'; '.join(reasons)}"

    def __repr__(self) -> str:
        """One line with the figures that tell contacts apart."""
        return (
            f"FiniteLineSolution({self.length * 1e3:.4g} mm, {self.profile}; film at mid length "
            f"{self.central_film * 1e6:.4f} um, minimum {self.minimum_film * 1e6:.4f} um, at the "
            f"ends {self.end_film * 1e6:.4g} um, edge pressure ratio "
            f"{self.edge_pressure_ratio:.3f}, M {self.moes_load:.4g}, L {self.moes_viscosity:.4g}, "
            f"{self.nodes_x} x {self.nodes_y} nodes, {self.cycles} cycles)"
        )
