"""A film formula with an option of its own: the isoviscous, rigid film of Martin."""

from tribodyn.ehl import FILM_MODELS
from tribodyn.model import number


@FILM_MODELS.define(
    "martin",
    source="Martin (1916): 4.9 times the entrainment over the load",
    meaning="central film of a rigid contact without the rise of viscosity under pressure",
    load_exponent=-1.0,
    options={
        "factor": number(4.9, 1.0, 10.0, "the solution has 4.9", meaning="factor of the formula"),
    },
)
def martin(
    load_per_width,
    equivalent_radius,
    entrainment_speed,
    dynamic_viscosity,
    pressure_viscosity_coefficient,
    effective_modulus,
    *,
    factor,
):
    """Film in the centre of each contact [m]."""
    return factor * dynamic_viscosity * entrainment_speed * equivalent_radius / load_per_width
