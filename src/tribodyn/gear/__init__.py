"""Gear geometry: involute tooth, rack-generated outline, gear, pair, mass and inertia.

| module | content |
| --- | --- |
| `curves` | involute and fillet, the curves of a tooth |
| `tooth_form` | the basic rack, and the tooth that it cuts: circles, thickness, flank and fillet |
| `cylindrical_gear` | a gear with a body: values in their range, a tooth that can be made |
| `outline` | the outline of a tooth and of a gear as points |
| `mass_properties` | material, mass and moment of inertia |
| `mesh_geometry` | what follows from two tooth forms and a centre distance |
| `contact_lines` | overlap of two faces, and length of the lines of contact |
| `cylindrical_pair` | two gears that can run together |
| `pair_checks` | why two gears cannot run together |
| `pair_factory` | a pair from the figures of a drawing |
| `modification` | modifications and deviations of the flanks of a gear, also as a map |
| `flank_gap` | the gap that modified flanks, pitch deviations and run-out leave |
| `hypoid` | hypoid and spiral bevel pairs: blank, flanks, contact |
"""

from tribodyn.arguments.pages import public_page

__all__, __getattr__, __dir__ = public_page(__name__, __file__)
