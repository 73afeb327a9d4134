"""Shear models of the oil by name: how its mean shear stress follows from the shear rate."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import Argument, InputError, require_between, require_positive
from tribodyn.model import NO_OPTIONS, Model, Registry, number
from tribodyn.nomenclature import positive
from tribodyn.types import Array, ByName

#: Limiting stress ``tau_L0 + Lambda p``, which every model may have.
LIMIT = {
    "limiting_stress": number(2e6, 1e4, 1e9, "oils have a few MPa", of="limiting_stress"),
    "limiting_stress_slope": number(
        0.05, 0.0, 0.3, "oils lie between 0.02 and 0.12", of="limiting_stress_slope"
    ),
}


@dataclass(frozen=True)
class ShearModel(Model):
    """A shear model: ``stress(rate, limit, **numbers)`` is the mean over the film.

    The rate is ``eta v_s/h`` [Pa], the stress that Newton's oil would have; the limit is that of
    the stress [Pa], infinite for none. The stress comes with its slope over ``ln(rate)``.
    """

    name: str  #: name in the registry
    source: str  #: paper behind the model
    stress: Callable[..., tuple[Array, Array]] = field(repr=False)
    options: ByName = field(default_factory=lambda: NO_OPTIONS)  #: numbers of the oil
    meaning: str = ""  #: one line
    papers: tuple[str, ...] = ()  #: keys of the bibliography
    #: Logarithm of what a pressure step h dp/dx leaves of the viscosity; None for all of it.
    across: Callable[..., Array] | None = field(default=None, repr=False)

    def complete(
        self, eyring_stress: float, numbers: Mapping[str, float | None]
    ) -> dict[str, float]:
        """All numbers of this model: those that are None at their defaults, others refused.

        The Eyring stress always has a value, so that a model without it leaves it alone. Without
        a number of the limit there is none, unless the model is made of it.
        """
        supplied = {name: value for name, value in numbers.items() if value is not None}
        parameters = {**self.declared, **(LIMIT if supplied.keys() & LIMIT.keys() else {})}
        for name in sorted(supplied.keys() - parameters.keys()):
            what = f'{name} does not belong to shear_model = "{self.name}"'
            why = f"Its numbers are: {', '.join({**parameters, **LIMIT})}"
            raise InputError(what, Argument(name), why, "Remove it, or choose another shear model")
        require_positive("eyring_stress", eyring_stress, "Pa", remedy="5 MPa is 5e6 Pa")
        values = {**{n: o.default for n, o in parameters.items()}, "eyring_stress": eyring_stress}
        values |= supplied
        for name, option in parameters.items():
            require_between(name, values[name], 0.0, np.inf, option.unit)
            if option.low > 0.0:
                require_positive(name, values[name], option.unit)
        return {name: values[name] for name in parameters}


#: Shear models by name.
SHEAR_MODELS: Registry[ShearModel] = Registry("shear model", None, ShearModel, "stress")


def newtonian_shear_stress(
    viscosity: ArrayLike, sliding_speed: ArrayLike, film_thickness: ArrayLike
) -> Array:
    """Mean shear stress over a film of a Newtonian oil: ``eta v_s / h``.

    Parameters
    ----------
    viscosity : float or array [Pa*s]
        Viscosity under the local pressure.
    sliding_speed : float or array [m/s]
        Difference of the surface speeds.
    film_thickness : float or array [m]
        Distance of the surfaces.

    Returns
    -------
    float or array [Pa]
        Of the common shape and the sign of the sliding speed. A pressure gradient does not change
        the mean; it adds ``-h/2 dp/dx`` at one surface and ``+h/2 dp/dx`` at the other.

    Raises
    ------
    InputError
        If a value is not finite, or a viscosity or film not positive.

    Valid while the stress stays below a few MPa. Source: Newton (1687).

    Examples
    --------
    >>> round(float(newtonian_shear_stress(10.0, 0.5, 1e-6)))
    5000000
    """
    require_positive("viscosity", viscosity, "Pa*s")
    require_between("sliding_speed", sliding_speed, -np.inf, np.inf, "m/s")
    require_positive("film_thickness", film_thickness, "m")
    eta, speed, film = (
        np.asarray(a, dtype=float) for a in (viscosity, sliding_speed, film_thickness)
    )
    return np.asarray(eta * speed / film)[()]


@SHEAR_MODELS.define(
    "newtonian",
    source="Newton (1687)",
    meaning="an oil whose shear stress is in proportion to the shear rate",
    papers=("newton",),
)
def _newtonian(rate: Array, limit: Array, **others: float) -> tuple[Array, Array]:
    return rate, rate


#: Usual Eyring stress of a mineral oil [Pa]. Traction tests give 2 to 10 MPa.
EYRING_STRESS = 5e6
#: The stress as an option.
EYRING = {
    "eyring_stress": number(
        EYRING_STRESS, 1e5, 1e8, "oils lie between 2 and 10 MPa", of="eyring_stress"
    )
}
#: Below this argument ``ln(y/sinh y)`` is its first term to the last bit.
_SMALL = 1e-4


def ree_eyring_shear_stress(
    viscosity: ArrayLike,
    sliding_speed: ArrayLike,
    film_thickness: ArrayLike,
    eyring_stress: float = EYRING_STRESS,
    pressure_gradient: ArrayLike = 0.0,
) -> Array:
    """Mean shear stress over a film that shears as ``(tau_0/eta) sinh(tau/tau_0)``.

    Across the film the stress is ``tau_m + z dp/dx``, with z from the middle. The shear rate,
    integrated over the film, is the sliding speed: with ``y = h dp/dx/(2 tau_0)``
    ``v_s = (2 tau_0^2/(eta dp/dx)) sinh(tau_m/tau_0) sinh(y)``, hence
    ``tau_m = tau_0 asinh[ eta v_s/(tau_0 h) y/sinh(y) ]``.

    Parameters
    ----------
    viscosity : float or array [Pa*s]
        Viscosity under the local pressure at small shear stress.
    sliding_speed : float or array [m/s]
        Difference of the surface speeds.
    film_thickness : float or array [m]
        Distance of the surfaces.
    eyring_stress : float [Pa]
        Stress ``tau_0`` from which the oil thins; 2 to 10 MPa for oils.
    pressure_gradient : float or array [Pa/m]
        Slope of the pressure along the film.

    Returns
    -------
    float or array [Pa]
        Of the common shape and the sign of the sliding speed.

    Raises
    ------
    InputError
        If a value is not finite, or a viscosity, film or Eyring stress not positive.

    Valid while the film is at one temperature across its thickness. Source: Ree and Eyring (1955);
    Conry, Wang and Cusano (1987) for the integral.

    Examples
    --------
    >>> round(float(ree_eyring_shear_stress(1000.0, 0.5, 1e-6)) / 1e6, 3)
    26.492
    >>> round(float(ree_eyring_shear_stress(1000.0, 0.5, 1e-6, 1e15)) / 1e6, 3)
    500.0
    """
    require_positive("viscosity", viscosity, "Pa*s")
    require_between("sliding_speed", sliding_speed, -np.inf, np.inf, "m/s")
    require_positive("film_thickness", film_thickness, "m")
    require_positive("eyring_stress", eyring_stress, "Pa", remedy="5 MPa is 5e6 Pa")
    require_between("pressure_gradient", pressure_gradient, -np.inf, np.inf, "Pa/m")
    speed, film, gradient = (
        np.asarray(a, dtype=float) for a in (sliding_speed, film_thickness, pressure_gradient)
    )
    rate = np.asarray(viscosity, dtype=float) * np.abs(speed) / film
    rate = rate * np.exp(_across(film * gradient, eyring_stress))
    return np.asarray(np.copysign(eyring_stress * np.arcsinh(rate / eyring_stress), speed))[()]


def _across(pressure_step: Array, eyring_stress: float, **others: float) -> Array:
    """Return ln(y/sinh(y)), which the pressure gradient leaves of the viscosity."""
    y = np.abs(pressure_step) / (2.0 * eyring_stress)
    safe = np.maximum(y, _SMALL)
    large = np.log(2.0 * safe) - safe - np.log1p(-np.exp(-2.0 * safe))
    return np.asarray(np.where(y < _SMALL, -(y**2) / 6.0, large))


@SHEAR_MODELS.define(
    "ree-eyring",
    source="Ree and Eyring (1955); Conry, Wang and Cusano (1987)",
    options=EYRING,
    across=_across,
    meaning="an oil that thins under shear after Ree and Eyring",
    papers=("ree-eyring", "conry-wang-cusano"),
)
def eyring(
    rate: Array, limit: Array, *, eyring_stress: float, **others: float
) -> tuple[Array, Array]:
    """Mean shear stress, and its slope over the logarithm of the rate."""
    sine = rate / eyring_stress
    return eyring_stress * np.arcsinh(sine), rate / np.hypot(1.0, sine)


#: The numbers of the law as options.
THINNING = {
    "carreau_stress": number(
        5e6, 1e3, 1e9, "oils lie between 10 kPa and 10 MPa", of="carreau_stress"
    ),
    "carreau_exponent": number(
        0.5, 0.05, 1.0, "1 is Newton's oil, oils have 0.3 to 0.9", of="carreau_exponent"
    ),
    "yasuda_exponent": number(2.0, 0.2, 20.0, "2 is Carreau's own", of="yasuda_exponent"),
}


def carreau_shear_stress(
    viscosity: ArrayLike,
    sliding_speed: ArrayLike,
    film_thickness: ArrayLike,
    carreau_stress: float = 5e6,
    carreau_exponent: float = 0.5,
    yasuda_exponent: float = 2.0,
) -> Array:
    """Shear stress of a film that thins as a power of the rate: Carreau and Yasuda.

    ``tau = s [1 + (s/G)^a]^((n - 1)/a)`` with ``s = eta v_s/h``, the stress of Newton's oil.

    Parameters
    ----------
    viscosity, sliding_speed, film_thickness : float or array [Pa*s], [m/s], [m]
        As for :func:`ree_eyring_shear_stress`.
    carreau_stress : float [Pa]
        Stress ``G`` from which the oil thins.
    carreau_exponent : float
        Exponent ``n`` of the stress over the rate far beyond; 1 for Newton's oil.
    yasuda_exponent : float
        Sharpness ``a`` of the bend; 2 is Carreau's own.

    Returns
    -------
    float or array [Pa]
        Of the common shape and the sign of the sliding speed.

    Raises
    ------
    InputError
        If a value is not finite, or one but the sliding speed not positive.

    Valid where the stress hardly varies across the film, ``h dp/dx << tau``. Source: Carreau
    (1972); Yasuda, Armstrong and Cohen (1981).

    Examples
    --------
    >>> round(float(carreau_shear_stress(1000.0, 0.5, 1e-6)) / 1e6, 3)
    49.999
    >>> round(float(carreau_shear_stress(1000.0, 0.5, 1e-6, carreau_exponent=1.0)) / 1e6, 3)
    500.0
    """
    eta, film, *numbers = positive(
        viscosity=viscosity,
        film_thickness=film_thickness,
        carreau_stress=carreau_stress,
        carreau_exponent=carreau_exponent,
        yasuda_exponent=yasuda_exponent,
    )
    require_between("sliding_speed", sliding_speed, -np.inf, np.inf, "m/s")
    speed = np.asarray(sliding_speed, dtype=float)
    rate = np.abs(eta * speed / film)
    named = dict(zip(THINNING, map(float, numbers), strict=True))
    return np.asarray(np.copysign(carreau(rate, rate, **named)[0], speed))[()]


@SHEAR_MODELS.define(
    "carreau",
    source="Carreau (1972); Yasuda, Armstrong and Cohen (1981)",
    options=THINNING,
    meaning="an oil that thins as a power of the shear rate after Carreau and Yasuda",
    papers=("carreau", "yasuda-armstrong-cohen"),
)
def carreau(
    rate: Array,
    limit: Array,
    *,
    carreau_stress: float,
    carreau_exponent: float,
    yasuda_exponent: float,
    **others: float,
) -> tuple[Array, Array]:
    """Mean shear stress, and its slope over the logarithm of the rate."""
    with np.errstate(divide="ignore"):
        power = yasuda_exponent * np.log(rate / carreau_stress)
    bend = np.logaddexp(0.0, power)
    stress = rate * np.exp((carreau_exponent - 1.0) / yasuda_exponent * bend)
    return stress, stress * (1.0 + (carreau_exponent - 1.0) * np.exp(power - bend))


@SHEAR_MODELS.define(
    "carreau-eyring",
    source="Carreau (1972), inside of Ree and Eyring (1955)",
    options={**EYRING, **THINNING},
    across=SHEAR_MODELS["ree-eyring"].across,
    meaning="an oil that thins after Carreau, and what is left of it after Ree and Eyring",
    papers=("carreau", "yasuda-armstrong-cohen", "ree-eyring"),
)
def _carreau_eyring(
    rate: Array, limit: Array, *, eyring_stress: float, **thinning: float
) -> tuple[Array, Array]:
    """Eyring's stress ``tau_0 asinh(tau_C/tau_0)`` of the viscosity that Carreau leaves."""
    thinned, slope = carreau(rate, limit, **thinning)
    stress, outer = eyring(thinned, limit, eyring_stress=eyring_stress)
    # Slopes are over logarithms: the outer one is over that of the thinned stress.
    return stress, outer * np.divide(slope, thinned, out=np.ones_like(slope), where=thinned > 0.0)


def bair_winer_shear_stress(
    viscosity: ArrayLike,
    sliding_speed: ArrayLike,
    film_thickness: ArrayLike,
    pressure: ArrayLike,
    limiting_stress: float = 2e6,
    limiting_stress_slope: float = 0.05,
) -> Array:
    """Shear stress of a film that yields at ``tau_L = tau_L0 + Lambda p``.

    ``v_s/h = -(tau_L/eta) ln(1 - tau/tau_L)``, hence ``tau = tau_L [1 - exp(-eta v_s/(h tau_L))]``.

    Parameters
    ----------
    viscosity, sliding_speed, film_thickness : float or array [Pa*s], [m/s], [m]
        As for :func:`ree_eyring_shear_stress`.
    pressure : float or array [Pa]
        Pressure above ambient.
    limiting_stress : float [Pa]
        Limiting stress ``tau_L0`` at ambient pressure.
    limiting_stress_slope : float
        Rise ``Lambda`` of the limiting stress per pressure; 0.02 to 0.12 for oils.

    Returns
    -------
    float or array [Pa]
        Of the common shape and the sign of the sliding speed.

    Raises
    ------
    InputError
        If a value is not finite, the pressure or slope negative, or another one not positive.

    Valid where the stress hardly varies across the film, ``h dp/dx << tau``. Source: Bair and
    Winer (1979).

    Examples
    --------
    >>> round(float(bair_winer_shear_stress(1000.0, 0.5, 1e-6, 1e9)) / 1e6, 3)
    51.997
    >>> round(float(bair_winer_shear_stress(10.0, 0.5, 1e-6, 1e9, 1e12)) / 1e6, 3)
    5.0
    """
    eta, film, limit = positive(
        viscosity=viscosity, film_thickness=film_thickness, limiting_stress=limiting_stress
    )
    require_between("sliding_speed", sliding_speed, -np.inf, np.inf, "m/s")
    require_between("pressure", pressure, 0.0, np.inf, "Pa")
    require_between("limiting_stress_slope", limiting_stress_slope, 0.0, np.inf)
    speed, load = np.asarray(sliding_speed, dtype=float), np.asarray(pressure, dtype=float)
    limit = limit + limiting_stress_slope * load
    return np.asarray(np.copysign(_bair_winer(eta * np.abs(speed) / film, limit)[0], speed))[()]


@SHEAR_MODELS.define(
    "bair-winer",
    source="Bair and Winer (1979)",
    options=LIMIT,
    meaning="an oil whose shear stress tends to a limit that grows with the pressure",
    papers=("bair-winer",),
)
def _bair_winer(rate: Array, limit: Array, **others: float) -> tuple[Array, Array]:
    return -limit * np.expm1(-rate / limit), rate * np.exp(-rate / limit)
