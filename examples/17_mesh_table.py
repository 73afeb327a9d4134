"""A mesh table of another program: its stiffness and errors, the same dynamics and reports.

The file is written by hand: the stiffness of a helical pair, a mean with a cosine at mesh
frequency, and a transmission error without load. Any program can write such a file, whose format
docs/mesh-table-file.md describes. It needs no tooth geometry: teeth, masses and moments of
inertia are in the case.

Run it with a folder to keep the report: ``python examples/17_mesh_table.py report``.
"""

import sys
import tempfile
from pathlib import Path

import numpy as np

import tribodyn as td

MEAN, SWING, ERROR = 450.0, 20.0, 1.5  # N/um, N/um, um

CASE = """
title = "Helical pair from a mesh table"

[gears]
kind = "table"
table = "mesh.csv"
driver = "pinion"

[gears.pinion]
teeth = 29
mass = "1.4 kg"
moment_of_inertia = "1500 kg*mm^2"

[gears.wheel]
teeth = 53
mass = "4.4 kg"
moment_of_inertia = "15000 kg*mm^2"

[operation]
speed = "3000 rpm"
torque = "150 N*m"

[dynamics]
bearing_stiffness = "1e9 N/m"
mesh_damping_ratio = 0.05
"""

folder = Path(tempfile.mkdtemp())
phase = np.linspace(0.0, 1.0, 129)
wave = np.cos(2.0 * np.pi * phase)
rows = np.stack([phase, MEAN + SWING * wave, ERROR * wave], axis=1)
lines = [
    "# base_radius_pinion = 42.5 mm",
    "# base_radius_wheel = 77.7 mm",
    "phase,stiffness [N/um],unloaded_transmission_error [um]",
    *(",".join(f"{value:.12g}" for value in row) for row in rows),
]
(folder / "mesh.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
(folder / "case.toml").write_text(CASE, encoding="utf-8")

result = td.run(td.load_case(folder / "case.toml"))
figures = result.summary()
print(f"mesh frequency      {figures['mesh_frequency']:.1f} Hz")
print(f"static mesh force   {figures['static_mesh_force']:.1f} N")
print(f"mean mesh force     {figures['mean_mesh_force']:.1f} N")
print(f"peak mesh force     {figures['peak_mesh_force']:.1f} N")
swing = 1e6 * figures["peak_to_peak_dynamic_transmission_error"]
print(f"transmission error  {swing:.3f} um peak to peak")

if len(sys.argv) > 1:
    print(f"report in {result.save(sys.argv[1])}")
