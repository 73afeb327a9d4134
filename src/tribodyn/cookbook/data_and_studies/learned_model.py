"""How do I predict a steady response without computing it?

A small network learns from computed operating points and states its error over points held
out.

Read on: learning
"""

import tribodyn as td
from tribodyn import surrogate

case = td.load_case("fzg-roughness")
over = {"operation.speed": "600 rpm .. 1800 rpm", "operation.torque": "50 N*m .. 150 N*m"}
data = td.operating_data(case, over, size=64, seed=1)
model = surrogate.train(
    data, features=list(over), targets=["rms_mesh_force"], seed=1,
    training=surrogate.Training(hidden=(6, 6), epochs=60),
)  # fmt: skip
print(model)
model.plot().write_html("learned_model.html")
