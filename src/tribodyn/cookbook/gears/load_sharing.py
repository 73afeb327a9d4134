"""How do the tooth pairs share the load?

The loaded tooth contact couples all pairs in mesh; contact before A and after E is included.

Read on: stiffness, mesh
"""

import tribodyn as td

case = td.load_case("fzg-roughness").replace({"stiffness.model": "analytic"})
contact = td.loaded_contact(case, torque=["30 N*m", "90 N*m", "150 N*m"])
print(contact)
contact.plot_load_sharing().write_html("load_sharing.html")
