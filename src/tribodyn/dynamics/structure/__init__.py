"""The structures that vibrate, and what their contacts read from a mesh.

The public names stand on the page of :mod:`tribodyn.dynamics`.

| module | what it answers |
|---|---|
| ``structures`` | which structures a case can choose, by name |
| ``gear_pair`` | two gears that turn, on bearings or fixed axes; directions, torques, balance |
| ``fzg12`` | the gear test rig with twelve coordinates |
| ``hypoid14`` | a hypoid pair in space with engine and load, fourteen coordinates |
| ``shafts`` | drives of shafts, discs and several meshes |
| ``force_law`` | contacts with a stiffness, a tangent or the whole force law |
"""
