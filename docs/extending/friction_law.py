"""A friction law with options of its own: a coefficient that falls with the sliding speed."""

import numpy as np

from tribodyn.friction import LAWS
from tribodyn.model import REQUIRED, number


@LAWS.define(
    "falling",
    source="Own tests of 2026, unpublished",
    meaning="friction coefficient that falls exponentially with the sliding speed",
    needs_oil=False,
    options={
        "start": number(
            REQUIRED, 0.0, 0.5, "dry steel has 0.5", of="friction_coefficient", example="0.08"
        ),
        "slope": number(
            0.3, 0.0, 10.0, "the tests end there", unit="s/m", meaning="fall with the sliding speed"
        ),
    },
)
def falling(contact, *, start, slope):
    """Friction coefficient of every contact."""
    return start * np.exp(-slope * np.abs(contact.sliding_speed))
