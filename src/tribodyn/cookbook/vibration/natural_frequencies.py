"""At which speeds does the mesh excite a natural frequency?

The Campbell diagram crosses the natural frequencies with the mesh harmonics.

Read on: nonlinear, dynamics
"""

import tribodyn as td

case = td.load_case("fzg-12dof")
print(td.natural_modes(case))
diagram = td.campbell(case, between=("300 rpm", "3500 rpm"), orders=(1, 2, 3))
for resonance in diagram.resonances[:3]:
    speed = resonance.speed * 30 / 3.14159
    print(f"mesh harmonic {resonance.order} meets mode {resonance.mode} at {speed:.0f} rpm")
diagram.plot().write_html("natural_frequencies.html")
