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

from tribodyn.arguments.pages import public_page

__all__, __getattr__, __dir__ = public_page(__name__, __file__)
