"""Lumped structures with gears, and the contacts of their meshes.

The public names are those of :mod:`tribodyn.dynamics`.

| module | content |
|---|---|
| ``structures`` | registry of the structures that a case can choose; contacts over both gears |
| ``gear_pair`` | two gears on bearings or fixed axes; directions, torques, balance |
| ``fzg12`` | the gear test rig with twelve coordinates |
| ``helical12`` | two cylindrical gears that move and tilt in space, twelve coordinates |
| ``hypoid14`` | a hypoid pair in space with engine and load, fourteen coordinates |
| ``shafts`` | drives of shafts, discs and several meshes |
| ``force_law`` | contacts with a stiffness, a tangent or a force law |
"""
