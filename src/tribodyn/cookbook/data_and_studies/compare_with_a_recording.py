"""How close is the computed vibration to a measured one?

The mesh harmonics of a result are compared with those of a recording, whose speed is found from its
mesh lines or from a tachometer. The recording of this example runs 1 % faster than the result.

Read on: measured-signals
"""

import numpy as np

import tribodyn as td
from tribodyn.measurement import Recording, compare

result = td.run("fzg-roughness")
amplitudes = 1.2 * result.to_xarray()["acceleration_loa_pinion_spectrum"].values[:40]
angle = 2 * np.pi * 1.01 * result.mesh.mesh_frequency * np.arange(51_200) / 25_600.0
signal = sum(a * np.cos(k * angle) for k, a in enumerate(np.abs(amplitudes), 1))
signal += np.random.default_rng(1).normal(0.0, 0.05, signal.size)
recording = Recording({"acc": signal}, 25_600.0, {"acc": "m/s^2"})
comparison = compare(result, recording, {"acc": "acceleration_loa_pinion"})
print(comparison)
comparison.plot().write_html("compare_with_a_recording.html")
