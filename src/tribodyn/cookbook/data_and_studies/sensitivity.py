"""Which uncertain input matters most?

Sobol indices split the variance of a figure among the inputs; here the minimum film after
Dowson and Higginson.

Read on: uncertainty
"""

from tribodyn.ehl import FILM_MODELS
from tribodyn.uncertainty import sobol_indices


def minimum_film(x):
    return FILM_MODELS["dowson-higginson"].minimum(
        x["load_per_width"], 8e-3, x["entrainment_speed"], x["dynamic_viscosity"], 2.19e-8, 2.2e11
    )


inputs = {
    "load_per_width": "148 kN/m +- 10 %",
    "entrainment_speed": "3.1 m/s +- 2 %",
    "dynamic_viscosity": "80 mPa*s +- 10 %",
}
indices = sobol_indices(minimum_film, inputs, size=1024, seed=1)
print(indices)
indices.plot().write_html("sensitivity.html")
