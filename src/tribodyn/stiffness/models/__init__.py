"""Stiffness models of the literature: each registers itself.

| module | what it answers |
| --- | --- |
| `prescribed` | prescribed stiffness: constant in each zone, a Fourier series, a table |
| `iso6336` | single and mesh stiffness of the standard, as a parabola over the path |
| `potential_energy` | energy method with true fillets, foundation and local compression |
"""
