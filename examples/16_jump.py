"""Jump of a gear pair with backlash: two motions at one speed, and which start leads to which.

A pair of equal spur gears of the kind on which Blankenship and Kahraman measured the jump of the
transmission error, with plausible values: near its resonance the teeth separate, the mean
stiffness decreases with the amplitude, and the resonance curve leans over. Between two speeds
a loud and a quiet motion coexist. Which one develops depends on the initial state: from below or
from above, or from any state of the plane of basins.

Figures are written to the folder ``figures``, or to the folder passed as argument.
"""

import math
import sys
from pathlib import Path

import numpy as np

from tribodyn.analysis import basins, bifurcation, phase_portrait
from tribodyn.dynamics import Contact, System, continuation, steady_state

MASS, STIFFNESS, RATIO = 1.15, 3.8e8, 0.02  # kg, N/m, damping ratio
BACKLASH, LOAD = 0.14e-3, 4800.0  # m, N along the line of action
natural = math.sqrt(STIFFNESS / MASS)  # rad/s

teeth = Contact(
    direction=[1.0],
    stiffness=lambda phase: STIFFNESS * (1.0 + 0.06 * np.cos(2.0 * np.pi * phase)),
    damping=2.0 * RATIO * math.sqrt(STIFFNESS * MASS),
    gap=0.5 * BACKLASH,
)
pair = System([[MASS]], [[0.0]], [[0.0]], [LOAD], [teeth], names=["x"])
print(f"resonance of small vibrations  {natural / (2.0 * math.pi):.1f} Hz")

# The branch, stable and unstable, and its two turning points.
ends = (2300.0, 3200.0)
branch = continuation(pair, between=ends, steps=256, longest_step=0.02)
folds = sorted(point.parameter for point in branch.special("fold"))
print(f"two motions between            {folds[0]:.1f} and {folds[-1]:.1f} Hz")

# Turning the speed up and down again.
speeds = np.linspace(*ends, 46)
swept = bifurcation(pair, speeds, sweep="both", steps=256)
differ = np.abs(swept.rms[0] - swept.rms[1]) > 0.05 * swept.rms.max()
print(f"the sweeps differ between      {speeds[differ][0]:.1f} and {speeds[differ][-1]:.1f} Hz")
print(f"verdicts                       {swept.verdicts()}")


def free_frequency(speed):
    """Frequency [Hz] and peak to peak [m] of the free vibration that begins at a speed [m/s]."""
    preload = LOAD / STIFFNESS
    reach = math.hypot(preload, speed / natural)
    contact = 2.0 / natural * (math.pi - math.acos(preload / reach))
    flight = 2.0 * speed * MASS / LOAD
    return 1.0 / (contact + flight), reach + preload + speed**2 * MASS / (2.0 * LOAD)


# The loudest motion lies on the backbone: the free vibration of the same amplitude.
top = int(np.argmax(branch.peak_to_peak[:, 0]))
speed = np.linspace(0.0, 2.0, 4001)
frequency, swing = np.array([free_frequency(v) for v in speed]).T
backbone = float(np.interp(branch.peak_to_peak[top, 0], swing, frequency))
print(f"loudest motion                 {branch.mesh_frequency[top]:.1f} Hz")
print(f"backbone at the same amplitude {backbone:.1f} Hz")

# Which start comes to which motion, in the middle of the two turning points.
middle = 0.5 * (folds[0] + folds[-1])
plane = basins(pair, middle, between=((4e-5, 1.2e-4), (-0.6, 0.6)), points=(81, 61), steps=128)
print(f"motions at {middle:.0f} Hz")
for each in plane.attractors:
    print(f"  rms {1e6 * each.rms:6.3f} um  share {100.0 * each.share:5.1f} %  {each.verdict}")
loud = max(plane.attractors, key=lambda each: each.rms)
orbit = steady_state(pair, middle, start=(loud.position[0], loud.velocity[0]))

portrait = phase_portrait(orbit, 0, gap=0.5 * BACKLASH)
folder = Path(sys.argv[1] if len(sys.argv) > 1 else "figures")
folder.mkdir(parents=True, exist_ok=True)
for name, result in (("branch", branch), ("sweeps", swept), ("basins", plane)):
    result.plot().write_html(folder / f"jump-{name}.html")
portrait.plot().write_html(folder / "jump-phase.html")
print(f"figures in {folder.resolve()}:")
print(*sorted(file.name for file in folder.glob("jump-*.html")))
