"""Finite elements of a complete gear with its face width: slices of the face that are coupled.

| module | content |
| --- | --- |
| `provider` | influence of one gear over radius and face, looked up on disk or computed |
| `sector` | section of one tooth with the top of the body, reduced to its flank and borders |
| `ring` | all teeth, harmonic by harmonic around the axis |
| `sections` | elements of a solid that turns along the face, splines over it, freedoms removed |
| `root_spread` | root stress along the face under a load at one place |
| `bevel` | influence over the flank of a hypoid or spiral bevel gear |
| `bevel_sector` | section of one of its teeth in hexahedra |
| `bevel_tooth` | flanks, fillets and cones of that tooth |
"""

from tribodyn.arguments.pages import public_page

__all__, __getattr__, __dir__ = public_page(__name__, __file__)
