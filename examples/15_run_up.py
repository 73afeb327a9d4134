"""Run-up and run-down of a spur gear pair: overall level, orders, resonances.

FZG gears at 20 N*m from 400 to 3000 rpm and back, as in a published test. Mesh stiffness and
friction are computed at a few speeds, and the speed changes while the gears vibrate. Peaks of the
orders of the mesh lie where they meet a natural frequency.

Figures are written to the folder ``figures``, or to the folder passed as argument.
"""

import sys
import warnings
from pathlib import Path

import numpy as np

import tribodyn as td
from tribodyn.analysis import order_cut, overall_level, resonances

warnings.simplefilter("ignore", td.ModelWarning)
case = td.load_case("fzg-roughness").replace({"operation.torque": "20 N*m"})
run = td.run_up(case, between=("400 rpm", "3000 rpm"), duration=1.5, down=True, tables=3)
rpm = 30.0 / np.pi
print(run)

for part in ("up", "down"):
    level = overall_level(run, "pinion_y", part=part)
    rising = np.argsort(level.speed)
    for speed in (1000, 2000, 2800):
        here = np.interp(speed, level.speed[rising] * rpm, level.rms[rising])
        print(f"{part:4} {speed} rpm  rms acceleration of the pinion {here:8.2f} m/s^2")

print("\norder  speed [rpm]  frequency [Hz]  mode at [Hz]  amplitude [m/s^2]")
for met in resonances(run, "pinion_y", orders=range(5, 13), part="up")[:6]:
    mode = f"{met.mode_frequency:12.0f}" if met.mode >= 0 else "        none"
    print(
        f"{met.order:5g} {met.speed * rpm:12.0f} {met.frequency:15.0f} {mode} {met.amplitude:17.1f}"
    )

mains = 2017.0 * 1.5 / 60.0
print(f"\norder 1.5 of the shaft at 2017 rpm is {mains:.1f} Hz: next to the mains of 50 Hz")
cut = order_cut(run, 1.5, "pinion_y", of="shaft", part="up")
print(f"its largest amplitude here {cut.amplitude.max():.2g} m/s^2: perfect gears do not excite it")

folder = Path(sys.argv[1] if len(sys.argv) > 1 else "figures")
folder.mkdir(parents=True, exist_ok=True)
run.plot().write_html(folder / "run-up.html")
run.plot_map().write_html(folder / "run-up-map.html")
print(f"\nfigures in {folder.resolve()}:")
print(*sorted(file.name for file in folder.glob("run-up*.html")))
