"""Film and load of a line contact over time, and its temperatures if it is heated."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from tribodyn.aliases import with_old_names
from tribodyn.ehl.thermal.thermal_model import ThermalModel
from tribodyn.ehl.transient.heated_steps import HeatOverTime
from tribodyn.ehl.transient.moving_contact import MovingContact
from tribodyn.record import Labels, Record, fact, from_parts, quantity, record
from tribodyn.types import Array, Index


@with_old_names
@record
class TransientLineContact(Record):
    """Film and load of a lubricated line contact over time, isothermal.

    Parameters
    ----------
    time : (m,) array [s]
        Instants.
    central_film, minimum_film : (m,) array [m]
        Film on the line of centres, and least film between inlet and outlet.
    load_per_width : (m,) array [N/m]
        Integral of the pressure; the imposed load, or the answer to the imposed approach.
    approach : (m,) array [m]
        Approach of the bodies since their undeformed flanks touched, where the deflection
        is counted from ``reference_length``; the imposed one, or the answer to the load.
    maximum_pressure : (m,) array [Pa]
        Highest pressure.
    outlet : (m,) array [m]
        Last position with pressure.
    equivalent_radius, entrainment_speed : (m,) array [m], [m/s]
        Reduced radius of curvature, and HALF the sum of the surface speeds.
    position : (n,) array [m]
        Nodes of the grid: distance from the line of centres in the direction of rolling.
    stored_instants : (k,) array of int
        Instants whose pressure and film are stored.
    pressure, film : (k, n) array [Pa], [m]
        Pressure and film at these instants.
    iterations, parts : (m,) array of int
        Newton steps of each time step, and parts that it was divided into; one unless it failed as
        a whole.
    balance_error : (m,) array [1]
        Sum of the mass balances over the mean flux.
    ruptured : (m,) array [m]
        Width of the cavities inside the film, before the outlet. A fast unloading tears it.
    half_width, hertz_pressure : float [m], [Pa]
        Half width of the widest dry contact, the unit of the grid, and its Hertz pressure.
    domain : (float, float) [b]
        First and last position, b being ``half_width``.
    reference_length : float [m]
        Distance from the line of centres at which a half space has the deflection zero.
    impose : str
        ``"load"`` or ``"approach"``.
    inlet : str
        ``"flooded"`` or ``"zero"``.
    """

    DERIVED: ClassVar[Mapping[str, Labels]] = {
        "stored_time": Labels(("kept_time",), "s", axis=True, name="kept_time")
    }

    time: Array = quantity("time", unit="s", axis=True)
    central_film: Array = quantity("time", unit="m")
    minimum_film: Array = quantity("time", unit="m")
    load_per_width: Array = quantity("time", unit="N/m")
    approach: Array = quantity("time", unit="m")
    maximum_pressure: Array = quantity("time", unit="Pa")
    outlet: Array = quantity("time", unit="m")
    equivalent_radius: Array = quantity("time", unit="m")
    entrainment_speed: Array = quantity("time", unit="m/s")
    position: Array = quantity("position", unit="m", axis=True)
    stored_instants: Index
    pressure: Array = quantity("kept_time", "position", unit="Pa")
    film: Array = quantity("kept_time", "position", unit="m")
    iterations: Index = quantity("time", unit="1")
    parts: Index = quantity("time", unit="1")
    balance_error: Array = quantity("time", unit="1")
    ruptured: Array = quantity("time", unit="m")
    half_width: float = fact()
    hertz_pressure: float = fact()
    domain: tuple[float, float]
    reference_length: float = fact()
    impose: str = fact()
    inlet: str = fact()

    @property
    def stored_time(self) -> Array:
        """Instants whose pressure and film are stored [s]."""
        return np.asarray(self.time[self.stored_instants])

    def __repr__(self) -> str:
        """One line with the main figures."""
        low, high = float(self.minimum_film.min()), float(self.central_film.max())
        return (
            f"{type(self).__name__}({self.time.size - 1} steps over "
            f"{(self.time[-1] - self.time[0]) * 1e3:.4g} ms, imposed {self.impose}, minimum film "
            f"{low * 1e6:.4f} um, greatest central film {high * 1e6:.4f} um, "
            f"{self.position.size} nodes)"
        )


@record
class ThermalTransientLineContact(TransientLineContact):
    """Film, load and temperatures of a lubricated line contact over time.

    Everything of :class:`TransientLineContact`, whose film is that of the heated oil, and:

    Parameters
    ----------
    surface_speeds : (2, m) array [m/s]
        Speeds of both surfaces.
    height : (across,) array [1]
        Distance of the nodes from surface 1 over the film.
    film_temperature : (k, n, across) array [K]
        Temperature of the oil from surface 1 to surface 2 at the stored instants; behind the
        outlet even between the surfaces.
    surface_temperatures : (k, 2, n) array [K]
        Temperature of both surfaces at the stored instants.
    highest_film_temperature : (m,) array [K]
        Highest temperature of the oil.
    highest_surface_temperatures : (2, m) array [K]
        Highest temperature of each surface.
    traction : (m,) array [N/m]
        Sliding traction, of the sign of the sliding.
    friction_coefficient : (m,) array
        Size of the traction over the load.
    shear_heat, compression_heat, carried_heat, stored_heat : (m,) array [W/m]
        Heat made by shear, and by compression less expansion; heat that the oil takes out, and
        heat by which that of the film grows.
    body_heat : (2, m) array [W/m]
        Heat into both bodies.
    heat_balance_error : (m,) array [1]
        Heat made, less heat led away and stored, over the greatest of these.
    thermal_passes : (m,) array of int
        Passes between film and temperatures.
    thermal_model : ThermalModel
        Shear of the oil, and bodies.
    """

    surface_speeds: Array = quantity("surface", "time", unit="m/s", default=None)
    height: Array = quantity("height", unit="1", axis=True, default=None)
    film_temperature: Array = quantity("kept_time", "position", "height", unit="K", default=None)
    surface_temperatures: Array = quantity(
        "kept_time", "surface", "position", unit="K", default=None
    )
    highest_film_temperature: Array = quantity("time", unit="K", default=None)
    highest_surface_temperatures: Array = quantity("surface", "time", unit="K", default=None)
    traction: Array = quantity("time", unit="N/m", default=None)
    friction_coefficient: Array = quantity("time", unit="1", default=None)
    shear_heat: Array = quantity("time", unit="W/m", default=None)
    compression_heat: Array = quantity("time", unit="W/m", default=None)
    carried_heat: Array = quantity("time", unit="W/m", default=None)
    stored_heat: Array = quantity("time", unit="W/m", default=None)
    body_heat: Array = quantity("surface", "time", unit="W/m", default=None)
    heat_balance_error: Array = quantity("time", unit="1", default=None)
    thermal_passes: Index = quantity("time", unit="1", default=None)
    thermal_model: ThermalModel = ThermalModel()


def solution_over_time(
    contact: MovingContact, records: Array, stored_instants: Index, pressures: Array, films: Array
) -> TransientLineContact:
    """Result in SI of the records of the kernel."""
    inputs, scale = contact.inputs, contact.scale
    offset, total, load, central, minimum, free, steps, flux, parts, highest, _, cavities = (
        records.T
    )
    X = np.linspace(*contact.domain, contact.nodes)
    if inputs.approach is None:
        # The kernel counts the deflection from the distance b.
        offset = offset - total * np.log(contact.depth) / np.pi
    return TransientLineContact(
        time=inputs.time,
        central_film=central * scale.film,
        minimum_film=minimum * scale.film,
        load_per_width=load * scale.pressure * scale.half_width,
        approach=-offset * scale.film,
        maximum_pressure=highest * scale.pressure,
        outlet=X[free.astype(int)] * scale.half_width,
        equivalent_radius=inputs.radius,
        entrainment_speed=inputs.entrainment_speed,
        position=X * scale.half_width,
        stored_instants=stored_instants,
        pressure=pressures * scale.pressure,
        film=films * scale.film,
        iterations=steps.astype(int),
        parts=parts.astype(int),
        balance_error=flux,
        ruptured=cavities * contact.dx * scale.half_width,
        half_width=scale.half_width,
        hertz_pressure=scale.pressure,
        domain=contact.domain,
        reference_length=contact.length,
        impose="load" if inputs.approach is None else "approach",
        inlet=contact.inlet,
    )


def with_heat_over_time(
    contact: TransientLineContact, speeds: Array, heat: HeatOverTime, model: ThermalModel
) -> ThermalTransientLineContact:
    """A contact over time with the temperatures that belong to it."""
    shear, compression, first, second, carried, stored, missing = heat.balance.T
    greatest = np.max(np.abs(heat.balance[:, :-1]), axis=1)
    return from_parts(
        ThermalTransientLineContact,
        *(contact, heat),
        surface_speeds=speeds,
        height=np.linspace(0.0, 1.0, model.nodes_across),
        film_temperature=heat.temperature,
        surface_temperatures=np.ascontiguousarray(
            heat.temperature[:, :, [0, -1]].transpose(0, 2, 1)
        ),
        highest_film_temperature=heat.highest[:, 0],
        highest_surface_temperatures=np.ascontiguousarray(heat.highest[:, 1:].T),
        friction_coefficient=np.abs(heat.traction) / contact.load_per_width,
        shear_heat=shear,
        compression_heat=compression,
        carried_heat=carried,
        stored_heat=stored,
        body_heat=np.stack([first, second]),
        heat_balance_error=missing / np.maximum(greatest, 1e-300),
        thermal_passes=heat.passes,
        thermal_model=model,
    )
