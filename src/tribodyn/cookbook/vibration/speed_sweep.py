"""Where does the pair jump when the speed rises and falls?

Steady motions over the speed, followed upwards and downwards; where the two differ, two motions
exist.

Read on: nonlinear
"""

import tribodyn as td

case = td.load_case("fzg-stiffness")
sweep = td.speed_sweep(case, ("3000 rpm", "6000 rpm"), points=40)
print(sweep)
for jump in sweep.jumps:
    print(f"{jump.direction}: jump at {jump.before:.0f} Hz mesh frequency")
sweep.plot().write_html("speed_sweep.html")
