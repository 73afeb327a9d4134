"""Figures of diagnosis: demodulated mesh harmonic."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.signals.revolution import finer
from tribodyn.plot.theme.labels import significant
from tribodyn.plot.theme.panels import Panel, stack
from tribodyn.plot.theme.style import PINION, TOTAL, line

if TYPE_CHECKING:
    from tribodyn.analysis import NarrowbandDemodulation

_ZERO = {"zeroline": True, "zerolinecolor": "#c5ccd3"}


@drawing(
    "narrowband_demodulation",
    heading="Demodulated mesh harmonic",
    caption="Amplitude and phase of a mesh harmonic over the angle of the shaft. A slow wave is "
    "run-out; a short dip of the phase is a tooth that yields, such as one with a root crack.",
    of="NarrowbandDemodulation",
    made_by="Call tribodyn.analysis.narrowband_demodulation(average) and its plot method.",
)
def narrowband_demodulation(demodulation: NarrowbandDemodulation) -> Any:
    """Draw amplitude and phase modulation over the angle of the shaft."""
    size = finer(100.0 * demodulation.amplitude_modulation)
    phase = finer(demodulation.phase_modulation)
    angle = 360.0 * np.arange(size.size) / size.size
    lowest = int(np.argmin(phase))
    panels = [
        Panel("Amplitude [%]", [line(angle, size, "amplitude", TOTAL, unit="%")], _ZERO),
        Panel("Phase [rad]", [line(angle, phase, "phase", PINION, unit="rad")], _ZERO),
    ]
    return stack(
        f"Mesh harmonic {demodulation.harmonic}: amplitude {significant(float(size.min()))} to "
        f"{significant(float(size.max()))} %, phase lags most at "
        f"{significant(float(angle[lowest]))}°, by {significant(float(-phase[lowest]))} rad",
        "Angle of the shaft [°]",
        panels,
        {"xaxis": {"range": [0.0, 360.0], "dtick": 45}},
    )
