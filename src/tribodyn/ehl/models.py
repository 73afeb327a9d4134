"""Film models by name: which formula gives the central and which the minimum film."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tribodyn.ehl.dowson import dowson_1968_minimum
from tribodyn.ehl.dowson_toyoda import dowson_toyoda_central
from tribodyn.ehl.moes import moes_central
from tribodyn.ehl.pan_hamrock import pan_hamrock_central, pan_hamrock_minimum
from tribodyn.registry import Registry

__all__ = ["FILM_MODELS", "FilmFormula", "FilmModel"]

#: Film [m] from load per width, equivalent radius, entrainment speed, dynamic viscosity,
#: pressure-viscosity coefficient and effective modulus, in this order and in SI.
FilmFormula = Callable[..., NDArray[np.float64]]


@dataclass(frozen=True)
class FilmModel:
    """A film model: the formulas that it has.

    Parameters
    ----------
    name : str
        Name in the registry.
    source : str
        Papers behind the formulas.
    central : callable, optional
        Formula of the central film; ``None`` where the model has none.
    minimum : callable, optional
        Formula of the minimum film; ``None`` where the model has none.

    Examples
    --------
    >>> FILM_MODELS["moes"].minimum is None
    True
    """

    name: str
    source: str
    central: FilmFormula | None = None
    minimum: FilmFormula | None = None


#: The film models by name; ``none`` computes no film.
FILM_MODELS: Registry[FilmModel] = Registry("film model", "tribodyn.film")

for _model in (
    FilmModel("none", "no film is computed"),
    FilmModel(
        "dowson-higginson",
        "minimum film: Dowson (1968); central film: Dowson and Toyoda (1979)",
        central=dowson_toyoda_central,
        minimum=dowson_1968_minimum,
    ),
    FilmModel(
        "pan-hamrock",
        "Pan and Hamrock (1989)",
        central=pan_hamrock_central,
        minimum=pan_hamrock_minimum,
    ),
    FilmModel("moes", "central film: Moes (1965, 2000)", central=moes_central),
):
    FILM_MODELS.register(_model.name)(_model)
