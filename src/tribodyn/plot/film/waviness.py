"""Waves of a moving surface in a lubricated contact."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.theme.labels import significant
from tribodyn.plot.theme.panels import Panel, stack
from tribodyn.plot.theme.style import MUTED, PINION, line

if TYPE_CHECKING:
    from tribodyn.ehl import AmplitudeReduction

_TICKS = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100]


@drawing(
    "amplitude_reduction",
    heading="Waves in the contact",
    caption="Amplitude of waves in the film over that of the free surface. Waves that are short "
    "against the inlet pass the contact as they are; long ones are flattened by the pressure. The "
    "curve is the fit of Venner, Couhier, Lubrecht and Greenwood to pure rolling.",
    of="AmplitudeReduction",
    made_by="Call tribodyn.ehl.solve_amplitude_reduction(...) and its plot method.",
)
def amplitude_reduction(waves: AmplitudeReduction) -> Any:
    """Draw the amplitude that waves keep over their length, with the curve of pure rolling."""
    from tribodyn.ehl import amplitude_reduction as fitted

    order = np.argsort(waves.wave_number, kind="stable")
    number = waves.wave_number[order]
    curve = np.geomspace(0.5 * number[0], 2.0 * number[-1], 200)
    per_number = waves.wavelength[0] / waves.wave_number[0]
    ratio = fitted(curve * per_number, waves.half_width, waves.moes_load, waves.moes_viscosity)
    solved = line(number, waves.amplitude_ratio[order], "transient solution", PINION)
    slide = waves.slide_to_roll_ratio
    motion = "pure rolling" if slide == 0.0 else f"a slide-to-roll ratio of {slide:g}"
    least, most = (significant(float(f(waves.amplitude_ratio)), 2) for f in (np.min, np.max))
    title = f"Waves keep {least} to {most} of their amplitude in {motion}"
    fit = line(curve, ratio, "fit for pure rolling", MUTED, dash="dash")
    solved |= {"mode": "markers", "marker": {"size": 9}}
    panel = Panel("Amplitude over that of the free surface", [fit, solved], {"range": [0.0, 1.02]})
    label = "Wavelength / half width · M<sup>3/4</sup> L<sup>-1/2</sup>"
    axis = {"type": "log", "tickvals": _TICKS, "tickformat": "~g"}
    return stack(title, label, [panel], {"xaxis": axis})
