"""Stiffness models of the literature: each file is one model and registers itself.

| module | what it answers |
| --- | --- |
| `table` | pair stiffness read from a table |
| `fourier` | mesh stiffness as a Fourier series over the mesh phase |
| `rectangular` | constant stiffness of each zone, with jumps between them |
| `iso6336` | single and mesh stiffness of the standard, as a parabola over the path |
| `potential_energy` | energy method with true fillets, foundation and local compression |
"""
