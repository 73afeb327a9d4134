"""How a gear gives way under a load on one of its teeth, in closed formulas.

| module | what it answers |
| --- | --- |
| `influence` | what a load on a tooth does there and at the other teeth (any provider) |
| `tooth_bending` | where a load meets a tooth, and how that beam with its true outline gives way |
| `tooth_compliance` | foundation of a tooth, wind-up of the body; all of one gear together |
| `weber` | local compression of the flanks; a tooth on a half plane |
| `analytic` | influence of a gear from beam teeth on an elastic ring |
"""
