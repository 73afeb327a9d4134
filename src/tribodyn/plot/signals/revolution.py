"""Synchronous average of a shaft with its residual and difference signal."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import Sketch, drawing
from tribodyn.plot.signals.maps import with_unit
from tribodyn.plot.theme.labels import label_with, readable
from tribodyn.plot.theme.panels import Panel, stack
from tribodyn.plot.theme.style import FILLS, GREY_ZERO, PINION, TOTAL, WHEEL, between, line
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
    mean = finer(average.signal)
    angle = 360.0 * np.arange(mean.size) / mean.size
    error = 2.0 * np.interp(angle, np.degrees(average.angle), average.scatter, period=360.0)
    band = between(angle, mean + error, mean - error, "2 standard errors", FILLS[PINION])
    band[0]["name"] = "standard error"
    difference = finer(average.difference())
    rows: tuple[tuple[Any, ...], ...] = (
        ("Mean revolution", mean, PINION, {}, 1.2),
        ("Residual", finer(average.residual()), TOTAL, GREY_ZERO, 1.0),
        ("Difference", difference, WHEEL, GREY_ZERO, 1.0),
    )
    panels: list[Panel] = []
    for name, values, color, axis, height in rows:
        trace = line(angle, values, name.lower(), color, unit=unit, width=1.4)
        traces = [trace] if panels else [*band, trace]
        panels.append(Panel(label_with(name.split()[0], unit), traces, axis, height))
    swing, bump = float(np.ptp(mean)), float(np.abs(difference).max())
    place, tooth = average.local_place()
    of_tooth = f", tooth {tooth} of {average.teeth}" if average.difference_is_clear else ""
    title = (
        f"{average.revolutions} revolutions: {with_unit(swing, average.unit)} peak to peak, "
        f"difference up to {with_unit(bump, average.unit)} "
        f"about {np.degrees(place):.0f}°{of_tooth}"
    )
    return over_a_turn(title, panels)


def over_a_turn(title: str, panels: list[Panel]) -> Sketch:
    """Stack panels over the angle of a shaft."""
    axis = {"range": [0.0, 360.0], "dtick": 45}
    return stack(title, "Angle of the shaft [°]", panels, {"xaxis": axis})
