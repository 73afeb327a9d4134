"""Harris map: static transmission error of a gear pair over the torque, with gear body deflection.

The quasi-static transmission error excites the vibration of the running gears: mean, peak to peak
and mesh harmonics at every torque. For comparison, the peak to peak value of independent tooth
pairs, which neglects that all teeth of a gear deflect a common body.

Figures are written to the folder ``figures``, or to the folder passed as argument.
"""

import sys
import warnings
from pathlib import Path

import tribodyn as td

warnings.simplefilter("ignore", td.ModelWarning)  # the thin tip and the undercut of this pair
torques = ["30 N*m", "60 N*m", "90 N*m", "150 N*m", "300 N*m"]
case = td.load_case("fzg-roughness").replace({"stiffness.model": "fe2d"})
harris = td.harris_map(case, torques)
independent = td.harris_map(case.replace({"stiffness.model": "potential-energy"}), torques)

print("torque   mean   peak to peak   harmonics 1, 2, 3    stiffness       pairs apart")
print("[N*m]    [um]   [um]           [um]                 [N/um]          peak to peak [um]")
for row, torque in enumerate(harris.torque):
    first, second, third = 1e6 * harris.harmonics[row, :3]
    print(
        f"{torque:5g} {1e6 * harris.mean_transmission_error[row]:8.3f} "
        f"{1e6 * harris.peak_to_peak_transmission_error[row]:10.3f}   "
        f"{first:9.3f} {second:6.3f} {third:6.3f} "
        f"{1e-6 * harris.mean_mesh_stiffness_secant[row]:11.1f} "
        f"{1e6 * independent.peak_to_peak_transmission_error[row]:15.3f}"
    )

folder = Path(sys.argv[1] if len(sys.argv) > 1 else "figures")
folder.mkdir(parents=True, exist_ok=True)
harris.plot().write_html(folder / "harris-map.html")
td.loaded_contact(case, torque="90 N*m").plot().write_html(folder / "loaded-contact.html")
print(f"figures in {folder.resolve()}:")
print("harris-map.html loaded-contact.html")
