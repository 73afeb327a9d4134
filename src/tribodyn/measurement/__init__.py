"""Measured signals: recordings of test rigs, the angle of the shaft, orders.

| module | what it answers |
|---|---|
| ``recording`` | what a file of a test rig holds; ``readers`` know the formats |
| ``tacho`` | how far the shaft has turned at each sample |
| ``mesh_speed`` | the same from the mesh lines of a recording without a tachometer |
| ``orders`` | how strong each order is, over a whole record and over the speed |
| ``vold_kalman`` | how single orders change with time |
| ``comparison`` | how far a computed motion is from a measured one |
| ``shaft_speed`` | angle and speed of the shaft, by the best source there is |
| ``signal_analysis`` | spectra, envelope, orders, mean revolution and indicators of one channel |
| ``synthetic`` | a run-up whose orders are known |
"""

from tribodyn.arguments import guard
from tribodyn.measurement.comparison import Comparison, compare
from tribodyn.measurement.mesh_speed import MeshSpeed, mesh_speed
from tribodyn.measurement.orders import OrderSpectrum, order_map, order_spectrum
from tribodyn.measurement.recording import Recording, read
from tribodyn.measurement.shaft_speed import ShaftSpeed
from tribodyn.measurement.signal_analysis import SignalAnalysis, analyse_signal
from tribodyn.measurement.synthetic import synthetic_run_up
from tribodyn.measurement.tacho import shaft_angle
from tribodyn.measurement.vold_kalman import TrackedOrders, track_orders

__all__ = [
    "Comparison",
    "MeshSpeed",
    "OrderSpectrum",
    "Recording",
    "ShaftSpeed",
    "SignalAnalysis",
    "TrackedOrders",
    "analyse_signal",
    "compare",
    "mesh_speed",
    "order_map",
    "order_spectrum",
    "read",
    "shaft_angle",
    "synthetic_run_up",
    "track_orders",
]

guard(__name__)
