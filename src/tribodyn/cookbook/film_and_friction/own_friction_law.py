"""How do I add a friction law of my own?

A function of the contact, whose attributes are arrays over the mesh cycle, with one decorator;
a case then picks the law by its name.

Read on: extending, friction
"""

import numpy as np

import tribodyn as td
from tribodyn.friction import LAWS


@LAWS.define("limited-shear", source="Own tests", meaning="shear stress limited to 60 MPa")
def limited_shear(contact):
    shear = np.minimum(80e6 * np.abs(contact.sliding_speed), 60e6)  # Pa
    return shear / contact.hertz_pressure


result = td.run(td.load_case("fzg-roughness").replace({"friction.law": "limited-shear"}))
print(f"mean friction coefficient {result.summary()['mean_friction_coefficient']:.4f}")
result.plot_friction().write_html("own_friction_law.html")
