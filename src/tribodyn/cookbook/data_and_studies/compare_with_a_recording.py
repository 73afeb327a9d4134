"""How close is the computed vibration to a measured one?

Levels and mesh harmonics of a result and of a recording, with the ratio of each.

Read on: measured-signals
"""

import numpy as np

import tribodyn as td
from tribodyn.measurement import Recording, compare

result = td.run(td.load_case("fzg-roughness"))
time = np.arange(51_200) / 25_600.0
signal = 3.0 * np.cos(2 * np.pi * result.mesh.mesh_frequency * time)
recording = Recording({"acc": signal}, 25_600.0, {"acc": "m/s^2"})
comparison = compare(result, recording, {"acc": "acceleration_loa_pinion"})
print(comparison)
comparison.plot().write_html("compare_with_a_recording.html")
