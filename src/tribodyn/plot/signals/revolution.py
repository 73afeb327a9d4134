"""Synchronous average of a shaft with its residual and difference signal."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.signals.maps import with_unit
from tribodyn.plot.theme.labels import readable
from tribodyn.plot.theme.panels import Panel, stack
from tribodyn.plot.theme.style import FILLS, PINION, TOTAL, WHEEL, Trace, line
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.analysis import SynchronousAverage

#: Most points of a curve; a mean revolution has 2.6 per mesh harmonic.
_POINTS = 6000
#: Points per period of the highest order.
_FINE = 4


def finer(values: Array) -> Array:
    """Evaluate the Fourier series of a signal at more angles, for a smooth curve."""
    from scipy.signal import resample

    return np.asarray(resample(values, min(_FINE * values.size, max(_POINTS, values.size))))


@drawing(
    "synchronous_average",
    heading="Mean revolution",
    caption="Vibration synchronous with the shaft, over its angle from the first pulse of the "
    "tachometer, or from the first sample where there is none. Above, the mean revolution with a "
    "band of two standard errors; below, the residual, without the mesh harmonics and the lowest "
    "shaft orders, and the difference, without their first sidebands too. A local bump of the "
    "difference indicates a faulty tooth.",
    of="SynchronousAverage",
    made_by="Call tribodyn.analysis.time_synchronous_average(...) and its plot method.",
)
def synchronous_average(average: SynchronousAverage) -> Any:
    """Draw mean revolution, residual and difference over the angle of the shaft."""
    unit = readable(average.unit)

    def label(quantity: str) -> str:
        return f"{quantity} [{unit}]" if unit else quantity

    mean = finer(average.signal)
    angle = 360.0 * np.arange(mean.size) / mean.size
    error = 2.0 * np.interp(angle, np.degrees(average.angle), average.scatter, period=360.0)
    edge: Trace = {"type": "scatter", "mode": "lines", "line": {"width": 0}, "hoverinfo": "skip"}
    band = [
        {**edge, "x": angle, "y": mean + error, "showlegend": False, "name": "standard error"},
        {**edge, "x": angle, "y": mean - error, "fill": "tonexty", "fillcolor": FILLS[PINION],
         "name": "2 standard errors"},
    ]  # fmt: skip
    residual, difference = finer(average.residual()), finer(average.difference())
    curve = line(angle, mean, "mean revolution", PINION, unit=unit, width=1.4)
    zero = {"zeroline": True, "zerolinecolor": "#c5ccd3"}
    panels = [
        Panel(label("Mean"), [*band, curve], height=1.2),
        Panel(
            label("Residual"),
            [line(angle, residual, "residual", TOTAL, unit=unit, width=1.4)],
            zero,
        ),
        Panel(
            label("Difference"),
            [line(angle, difference, "difference", WHEEL, unit=unit, width=1.4)],
            zero,
        ),
    ]
    swing, bump = float(np.ptp(mean)), float(np.abs(difference).max())
    place, tooth = average.local_place()
    of_tooth = f", tooth {tooth} of {average.teeth}" if average.difference_is_clear else ""
    return stack(
        f"{average.revolutions} revolutions: {with_unit(swing, average.unit)} peak to peak, "
        f"difference up to {with_unit(bump, average.unit)} "
        f"about {np.degrees(place):.0f}°{of_tooth}",
        "Angle of the shaft [°]",
        panels,
        {"xaxis": {"range": [0.0, 360.0], "dtick": 45}},
    )
