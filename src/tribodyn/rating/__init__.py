"""Load capacity of gears by ISO 6336: pitting, bending, scuffing, micropitting.

| module | content |
| --- | --- |
| `pair_rating` | pitting and bending of a cylindrical gear pair under one load |
| `spectrum` | the same under a load spectrum, damage by Miner: ISO 6336-6 |
| `factor` | a factor with unit, source and branch |
| `conditions` | application factor, life, edition, design of the leads, required safeties |
| `rated_gear` | material, accuracy, roughness and load cycles of a gear; its cutter and shaft |
| `materials` | strength by type, grade and hardness: ISO 6336-5 |
| `oil` | the oil as ratings need it |
| `tolerances` | deviations by accuracy grade: ISO 1328-1 |
| `mesh_load` | forces, speeds and running-in of one mesh |
| `influence` | K_v, K_Hbeta, K_Halpha: ISO 6336-1 |
| `pitting` | contact stress and its limit: ISO 6336-2 |
| `root_section`, `bending` | root stress and its limit: ISO 6336-3 |
| `root_elements` | root stress by finite elements, compared with it |
| `surface` | scuffing, micropitting: ISO/TS 6336-20, -21, -22; stress below the surface |
| `elements` | life of rolling bearings, shafts, load cycles: ISO 281, ISO/TS 16281, DIN 743 |
| `life` | Z_NT, Y_NT and cycles to failure |
"""

from tribodyn.arguments.pages import public_page

__all__, __getattr__, __dir__ = public_page(__name__, __file__)
