"""How do I read a recording of a test rig?

CSV, UFF, TDMS, MAT, HDF5 and WAV are read; units come from the header or from the sensitivity
you give.

Read on: measured-signals, signals
"""

from pathlib import Path

import numpy as np

from tribodyn.analysis import spectrum
from tribodyn.measurement import read

time = np.arange(4096) / 8192.0
voltage = 0.02 * np.cos(2 * np.pi * 400 * time)
rows = [f"{1e3 * t:.6f};{v:.6f}" for t, v in zip(time, voltage, strict=True)]
Path("rig.csv").write_text("\n".join(["time [ms];acc [V]", *rows]))
recording = read("rig.csv", sensitivity={"acc": "100 mV/g"})
lines = spectrum(recording["acc"], recording.sample_rate, unit=recording.units["acc"])
print(f"{recording}: strongest line {lines.amplitude.max():.3f} m/s^2")
lines.plot().write_html("read_a_recording.html")
