"""Measured signals: recordings of test rigs, the angle of the shaft, orders.

| module | content |
|---|---|
| ``recording`` | recordings of test rigs and :func:`read`; ``readers`` holds the file formats |
| ``tacho`` | shaft angle at each sample from a tachometer |
| ``mesh_speed`` | mesh speed and angle from the mesh lines, without a tachometer |
| ``orders`` | order spectrum of a recording, and order map over the speed |
| ``vold_kalman`` | amplitude and phase of single orders over time |
| ``load_history`` | load classes of a recorded torque |
| ``comparison`` | comparison of a computed with a measured response |
| ``shaft_speed`` | shaft angle, speed and mean revolutions from the best available source |
| ``sideband_cursors`` | sidebands of a carrier, and which of two gears modulates the mesh |
| ``signal_analysis`` | spectra, envelope, orders, mean revolution and indicators of one channel |
| ``synthetic`` | synthetic run-up with prescribed orders |
"""

from tribodyn.arguments import guard
from tribodyn.measurement.comparison import Comparison, compare
from tribodyn.measurement.mesh_speed import MeshSpeed, mesh_speed
from tribodyn.measurement.orders import OrderSpectrum, order_map, order_spectrum
from tribodyn.measurement.recording import Recording, read
from tribodyn.measurement.shaft_speed import ShaftSpeed
from tribodyn.measurement.sideband_cursors import (
    ShaftLines,
    SidebandCursors,
    modulating_shaft,
    sideband_cursors,
)
from tribodyn.measurement.signal_analysis import SignalAnalysis, analyse_signal
from tribodyn.measurement.synthetic import synthetic_run_up
from tribodyn.measurement.tacho import shaft_angle
from tribodyn.measurement.vold_kalman import TrackedOrders, track_orders

__all__ = [
    "Comparison",
    "MeshSpeed",
    "OrderSpectrum",
    "Recording",
    "ShaftLines",
    "ShaftSpeed",
    "SidebandCursors",
    "SignalAnalysis",
    "TrackedOrders",
    "analyse_signal",
    "compare",
    "mesh_speed",
    "modulating_shaft",
    "order_map",
    "order_spectrum",
    "read",
    "shaft_angle",
    "sideband_cursors",
    "synthetic_run_up",
    "track_orders",
]

guard(__name__)
