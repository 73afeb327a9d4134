"""Is the motion periodic, and is it the model or the step size?

A bifurcation diagram samples the motion once per mesh cycle; every point is checked at half the
step.

Read on: nonlinear
"""

import tribodyn as td

case = td.load_case("fzg-stiffness")
diagram = td.bifurcation(case, between=("4000 rpm", "6000 rpm"), points=20, sweep="both")
print(diagram)
diagram.plot().write_html("bifurcation.html")
