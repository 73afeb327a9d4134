"""Optimal tip relief of a gear pair from 60 to 120 N*m, and its effect at other torques.

A relief is optimal for one torque: below it the relief exceeds the deflection of the teeth, above
it the deflection is larger. The search minimizes the largest peak to peak transmission error in a
range of torques.

Figures are written to the folder ``figures``, or to the folder passed as argument.
"""

import sys
import warnings
from pathlib import Path

import numpy as np

import tribodyn as td

warnings.simplefilter("ignore", td.ModelWarning)  # the thin tip and the undercut of this pair
case = td.load_case("fzg-roughness").replace({"stiffness.model": "fe2d"})
best = td.optimize_tip_relief(case, ("60 N*m", "120 N*m"))
print(f"amount {1e6 * best.amount:.2f} um, length {1e3 * best.length:.2f} mm at both tips")
print(f"largest peak to peak before {1e6 * best.objective_before:.3f} um")
print(f"largest peak to peak after  {1e6 * best.objective:.3f} um")

# The same relief in the case file, over a wider range of torques.
relief = {"tip_relief": float(best.amount), "tip_relief_length": float(best.length)}
changes = {
    f"gears.{gear}.modification.{name}": value
    for gear in ("pinion", "wheel")
    for name, value in relief.items()
}
relieved, torques = case.replace(changes), np.array([15.0, 60.0, 75.0, 90.0, 105.0, 120.0, 200.0])
before, after = (td.harris_map(each, torques) for each in (case, relieved))
print("torque [N*m]   before [um]   after [um]")
for torque, plain, less in zip(
    torques,
    before.peak_to_peak_transmission_error,
    after.peak_to_peak_transmission_error,
    strict=True,
):
    print(f"{torque:8g} {1e6 * plain:14.3f} {1e6 * less:12.3f}")

folder = Path(sys.argv[1] if len(sys.argv) > 1 else "figures")
folder.mkdir(parents=True, exist_ok=True)
best.plot().write_html(folder / "tip-relief-map.html")
after.plot().write_html(folder / "tip-relief-harris.html")
print(f"figures in {folder.resolve()}:")
print("tip-relief-harris.html tip-relief-map.html")
