"""The solved line contact with its temperatures, its friction and its balance of heat."""

from __future__ import annotations

import numpy as np

from tribodyn.ehl.steady.solution import LineContactSolution
from tribodyn.ehl.thermal.thermal_contact import HeatedFilm
from tribodyn.ehl.thermal.thermal_model import ThermalModel
from tribodyn.record import fact, from_parts, quantity, record
from tribodyn.types import Array


@record
class ThermalLineContactSolution(LineContactSolution):
    """Pressure, film and temperatures of a lubricated line contact.

    Everything of :class:`LineContactSolution`, whose film is that of the heated oil, and:

    Parameters
    ----------
    sliding_speed : float [m/s]
        Speed of surface 1 less that of surface 2.
    height : (across,) array [1]
        Distance of the nodes from surface 1 over the film.
    film_temperature : (nodes, across) array [K]
        Temperature of the oil from surface 1 to surface 2; behind the outlet, where the oil has
        parted, even between the surfaces.
    surface_temperatures : (2, nodes) array [K]
        Temperature of both surfaces.
    shear_stress : (nodes,) array [Pa]
        Shear stress in the middle of the film, with which surface 2 drags surface 1 along.
    surface_heat : (2, nodes) array [W/m^2]
        Heat that each surface takes up.
    traction : float [N/m]
        Sliding traction, of the sign of the sliding.
    friction_coefficient : float
        Size of the traction over the load.
    shear_heat, compression_heat, carried_heat : float [W/m]
        Heat made by shear, and by compression less expansion; heat that the oil takes out.
    body_heat : (2,) array [W/m]
        Heat into both bodies.
    heat_balance_error : float [1]
        Heat made less heat led away, over the heat made by shear.
    thermal_passes : int
        Passes between film and temperatures.
    thermal_model : ThermalModel
        Shear of the oil, and bodies.
    """

    sliding_speed: float = fact(default=0.0)
    height: Array = quantity("height", unit="1", axis=True, default=None)
    film_temperature: Array = quantity("position", "height", unit="K", default=None)
    surface_temperatures: Array = quantity("surface", "position", unit="K", default=None)
    shear_stress: Array = quantity("position", unit="Pa", default=None)
    surface_heat: Array = quantity("surface", "position", unit="W/m^2", default=None)
    traction: float = fact(default=0.0)
    friction_coefficient: float = fact(default=0.0)
    shear_heat: float = fact(default=0.0)
    compression_heat: float = fact(default=0.0)
    carried_heat: float = fact(default=0.0)
    body_heat: Array = quantity("surface", unit="W/m", default=None)
    heat_balance_error: float = fact(default=0.0)
    thermal_passes: int = fact(default=0)
    thermal_model: ThermalModel = ThermalModel()
    _mean_viscosity: Array = None  # type: ignore[assignment]

    @property
    def log_mean_viscosity(self) -> Array:
        """Logarithm of the mean viscosity across the film at low stress [Pa*s]."""
        return np.log(self._mean_viscosity)


def with_heat(
    solution: LineContactSolution, heated: HeatedFilm, model: ThermalModel, sliding_speed: float
) -> ThermalLineContactSolution:
    """A solution with the temperatures that belong to it."""
    shear, compression, first, second, carried = heated.balance.tolist()
    generated = shear + compression
    temperature = heated.temperature
    return from_parts(
        ThermalLineContactSolution,
        *(solution, heated),
        sliding_speed=sliding_speed,
        height=np.linspace(0.0, 1.0, temperature.shape[1]),
        film_temperature=temperature,
        surface_temperatures=np.ascontiguousarray(temperature[:, [0, -1]].T),
        surface_heat=heated.heat,
        friction_coefficient=abs(heated.traction) / solution.load_per_width,
        shear_heat=shear,
        compression_heat=compression,
        carried_heat=carried,
        body_heat=np.array([first, second]),
        heat_balance_error=(generated - first - second - carried) / max(shear, 1e-300),
        thermal_passes=heated.passes,
        thermal_model=model,
        _mean_viscosity=heated.viscosity,
    )
