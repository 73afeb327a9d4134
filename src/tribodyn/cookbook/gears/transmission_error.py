"""How does the transmission error change with the torque?

The Harris map shows the static transmission error over the mesh cycle for each torque, its peak
to peak value and its mesh harmonics. No motion is computed.

Read on: stiffness, modifications
"""

import tribodyn as td

case = td.load_case("fzg-roughness").replace({"stiffness.model": "analytic"})
harris = td.harris_map(case, torque=["30 N*m", "90 N*m", "150 N*m", "300 N*m"])
for torque, error in zip(harris.torque, harris.peak_to_peak_transmission_error, strict=True):
    print(f"{torque:4.0f} N*m: {1e6 * error:.2f} um peak to peak")
harris.plot().write_html("transmission_error.html")
