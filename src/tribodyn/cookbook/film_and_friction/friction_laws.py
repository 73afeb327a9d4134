"""Which friction laws are there, and what do they give for my pair?

A law is a name in the case; `tribodyn explain friction` lists all laws, `tribodyn explain xu-2007`
prints the equation, range of use and source of one.

Read on: friction, friction-experiment
"""

import plotly.graph_objects as go

import tribodyn as td

case = td.load_case("fzg-roughness")
figure = go.Figure()
for law in ("benedict-kelly", "xu-2007", "odonoghue-cameron", "niemann"):
    mesh = td.run(case.replace({"friction.law": law})).mesh
    touching = mesh.in_contact[:, 0]
    friction = mesh.friction_coefficient[touching, 0]
    print(f"{law:18} mean {friction.mean():.4f}")
    figure.add_scatter(x=mesh.path[touching, 0] * 1e3, y=friction, name=law)
figure.update_layout(xaxis_title="Path of contact [mm]", yaxis_title="Friction coefficient")
figure.write_html("friction_laws.html")
