"""A stiffness model with an option of its own: a parabola over the path of contact."""

import numpy as np

from tribodyn.model import number
from tribodyn.stiffness import MODELS


@MODELS.define(
    "parabola",
    source="A first guess",
    meaning="pair stiffness as a parabola over the path of contact",
    options={
        "peak_stiffness": number(
            4e8, 1e6, 1e11, "guards against a wrong unit", of="pair_stiffness"
        ),
        "fall": number(0.3, 0.0, 0.9, "teeth do not vanish", meaning="loss at A and E"),
    },
)
def parabola(pair, material, path, in_contact, phase, normal_force, *, peak_stiffness, fall):
    """Stiffness of each tooth pair, zero where it is not in contact."""
    first, last = path[in_contact].min(), path[in_contact].max()
    place = (2.0 * path - first - last) / (last - first)
    return np.where(in_contact, peak_stiffness * (1.0 - fall * place**2), 0.0)
