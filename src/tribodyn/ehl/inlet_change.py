"""How the inlet before the first node of a steady contact follows the load."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

from tribodyn.ehl.domain import estimate_film

if TYPE_CHECKING:
    from tribodyn.ehl.solution import LineContactSolution


#: Change of ln(w) for the slope of the estimated film.
_STEP = 1e-4


class InletChange(NamedTuple):
    """Derivatives by the logarithm of the load, in ``p_h`` and ``b p_h``; zero without an inlet."""

    pressure: float  #: of the pressure at the first node
    load: float  #: of the load before the first node
    pressure_film: float
    load_film: float


def inlet_change(solution: LineContactSolution) -> InletChange:
    """How pressure and load of the inlet follow the load, as in the solver."""
    from tribodyn.ehl.kernel.flooded_inlet import flooded_inlet

    grid = solution._grid
    if grid.tail == 0.0:
        return InletChange(0.0, 0.0, 0.0, 0.0)

    def film(change: float) -> float:
        """Estimated film in the held unit b^2/R when ln(w) changes."""
        pressure = math.exp(0.5 * change)
        density = 1.0 + grid.oil[4] * pressure / (1.0 + grid.oil[5] * pressure)
        load = solution.moes_load * math.exp(change)
        return estimate_film(load, solution.moes_viscosity, density) * math.exp(change)

    slope = (film(_STEP) - film(-_STEP)) / (2.0 * _STEP)
    _, _, pressure_film, load_film, pressure_load, load_load = flooded_inlet(
        float(grid.X[0]), film(0.0), grid.lam, 1.0, 1.0
    )
    return InletChange(
        pressure_load + pressure_film * slope,
        load_load + load_film * slope,
        pressure_film,
        load_film,
    )
