"""A bifurcation that the integration step makes: mesh stiffness up to 2.17e7 N/mm.

A published diagram of this pair shows one motion per mesh cycle up to 1.731e7 N/mm, then several,
then chaos. The same comes out here with two hundred steps per mesh cycle, and the verdict says why:
the fastest motion of the structure turns by more than 2.7 rad in one step. With shorter steps every
motion repeats with the mesh, and its Floquet multipliers lie well inside the unit circle.

"Undecided" are motions that do repeat, while their rms of a hundredth of a micrometre depends on
the step: the printed formula of the mesh damping gives hardly any, and ringing is not resolved.

Figures go into the folder ``figures``, or into the one that is named behind the script.
"""

import sys
import warnings
from pathlib import Path

import numpy as np

import tribodyn as td

warnings.simplefilter("ignore", td.ModelWarning)  # of this pair
pair = td.load_case("fzg-stiffness")
# What the printed formula of the mesh damping gives as it stands.
case = pair.replace({"dynamics.mesh_damping_ratio": None, "dynamics.mesh_damping": "8 N*s/m"})

diagrams = {
    steps: td.bifurcation(
        case,
        over="stiffness.mean_stiffness",
        between=("1.1e5 N/mm", "2.17e7 N/mm"),
        points=points,
        steps=steps,
        cycles=32,
        keep=16,
    )
    for steps, points in ((200, 55), (800, 14))
}
for steps, found in diagrams.items():
    print(f"{steps} steps:", ", ".join(f"{n} {word}" for word, n in found.verdicts().items()))
    print(f"  greatest omega dt     {found.step_number.max():.4f}")
    print(f"  motions not period 1  {np.count_nonzero(found.period != 1)}")
    for words, which in (
        ("step-limited from ", found.verdict[0] == "step-limited"),
        ("not period 1 from ", found.period[0] != 1),
    ):
        if which.any():
            first = int(np.argmax(which))
            print(f"  {words}    {found.parameter[first] * 1e-3:.4g} N/mm, omega dt = "
                  f"{found.step_number[first]:.4f}, period {found.refined_period[0, first]} with "
                  f"{found.refined_steps[first]} steps")  # fmt: skip

print("mesh damping 4 % of critical")
print("  stiffness [N/mm]   largest multiplier")
for stiffness in (1.1e5, 3e5, 1e6, 1e7, 1.731e7, 1.741e7, 1.9e7, 2.17e7):
    orbit = td.run(pair.replace({"stiffness.mean_stiffness": f"{stiffness} N/mm"})).response
    state = "stable" if orbit.stable else "unstable"
    print(f"  {stiffness:16.4g}   {np.abs(orbit.floquet_multipliers).max():.4f}  {state}")

folder = Path(sys.argv[1] if len(sys.argv) > 1 else "figures")
folder.mkdir(parents=True, exist_ok=True)
diagrams[200].plot().write_html(folder / "stiffness-bifurcation.html")
print(f"figures in {folder.resolve()}:")
print(*sorted(found.name for found in folder.glob("stiffness-*.html")))
