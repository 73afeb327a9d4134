"""Numerical chaos from a long time step: bifurcation over mesh stiffness up to 2.17e7 N/mm.

A published diagram of this pair shows period-1 motion up to 1.731e7 N/mm, then several periods,
then chaos. Two hundred steps per mesh cycle reproduce it, and the verdict shows the cause:
the fastest mode of the structure turns by more than 2.7 rad in one step. With shorter steps every
motion has period 1, and its Floquet multipliers are well inside the unit circle.

"Undecided" marks periodic motions whose rms of a hundredth of a micrometre depends on
the step: the printed damping formula gives hardly any damping, and ringing is not resolved.

Figures are written to the folder ``figures``, or to the folder passed as argument.
"""

import sys
import warnings
from pathlib import Path

import numpy as np

import tribodyn as td

warnings.simplefilter("ignore", td.ModelWarning)  # of this pair
pair = td.load_case("fzg-stiffness")
# Mesh damping by the formula as printed.
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
for steps, diagram in diagrams.items():
    print(f"{steps} steps:", ", ".join(f"{n} {word}" for word, n in diagram.verdicts().items()))
    print(f"  greatest omega dt     {diagram.step_number.max():.4f}")
    print(f"  motions not period 1  {np.count_nonzero(diagram.period != 1)}")
    for label, matches in (
        ("step-limited from ", diagram.verdict[0] == "step-limited"),
        ("not period 1 from ", diagram.period[0] != 1),
    ):
        if matches.any():
            first = int(np.argmax(matches))
            print(f"  {label}    {diagram.parameter[first] * 1e-3:.4g} N/mm, omega dt = "
                  f"{diagram.step_number[first]:.4f}, period {diagram.refined_period[0, first]} "
                  f"with {diagram.refined_steps[first]} steps")  # fmt: skip

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
print(*sorted(file.name for file in folder.glob("stiffness-*.html")))
