"""Which tip relief makes the pair quiet?

The search minimizes the largest peak-to-peak transmission error over a range of torques. The
analytic tooth stiffness keeps it quick; use `"fe2d"` for the final design.

Read on: modifications, app
"""

import tribodyn as td

case = td.load_case("fzg-roughness").replace({"stiffness.model": "analytic"})
best = td.optimize_tip_relief(case, torque=("60 N*m", "120 N*m"))
print(f"relief of {1e6 * best.amount:.1f} um over {1e3 * best.length:.2f} mm on both tips")
print(f"error {1e6 * best.objective_before:.2f} um before, {1e6 * best.objective:.2f} um after")
best.plot().write_html("tip_relief.html")
