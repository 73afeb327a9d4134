"""Oil film and teeth in series over torque and speed, for two definitions of film stiffness.

The tangent is the slope of load over film, the stiffness for slow vibrations. The secant is the
sum of pressure over film: it makes the oil ten times softer, and the mesh depend on the speed.

Figures are written to the folder ``figures``, or to the folder passed as argument.
"""

import sys
import warnings
from pathlib import Path

import tribodyn as td

warnings.simplefilter("ignore", td.ModelWarning)  # light loads have films that do not yield
case = td.load_case("fzg-film")  # the wheel of 24 teeth drives; torque and speed are its own
torques, speeds = (50, 150, 300), (400, 1400, 3000)
figures = {}
for kind in ("tangent", "secant"):
    over_torque = td.comprehensive_stiffness(case, torque=[f"{t} N*m" for t in torques], kind=kind)
    over_speed = td.comprehensive_stiffness(case, speed=[f"{n} rpm" for n in speeds], kind=kind)
    figures[f"{kind}-torque"], figures[f"{kind}-speed"] = over_torque, over_speed
    print(f"{kind} film stiffness, means over the mesh cycle [N/um]")
    for stiffness, names in (
        (over_torque, [f"{torque} N*m" for torque in torques]),
        (over_speed, [f"{speed} rpm" for speed in speeds]),
    ):
        films = stiffness.film_mesh_stiffness.mean(axis=2).ravel()
        teeth, mesh = stiffness.mean_tooth_stiffness.ravel(), stiffness.mean_mesh_stiffness.ravel()
        for name, film, tooth, total in zip(names, films, teeth, mesh, strict=True):
            print(
                f"  {kind} {name:>9}  films {1e-6 * film:9.0f}  teeth {1e-6 * tooth:6.2f}  "
                f"both {1e-6 * total:6.2f}"
            )

folder = Path(sys.argv[1] if len(sys.argv) > 1 else "figures")
folder.mkdir(parents=True, exist_ok=True)
for name, stiffness in figures.items():
    stiffness.plot().write_html(folder / f"comprehensive-{name}.html")
print(f"figures in {folder.resolve()}:")
print(*sorted(path.name for path in folder.glob("comprehensive-*.html")))
