"""The structures that vibrate, and what their contacts read from a mesh.

The public names stand on the page of :mod:`tribodyn.dynamics`.

| module | what it answers |
|---|---|
| ``structures`` | which structures a case can choose, by name |
| ``gear_pair`` | what all models of one gear pair share: directions, torques, balance |
| ``torsional`` | two gears that only turn |
| ``spur6`` | two gears that turn and move on their bearings |
| ``fzg12``, ``fzg12_mesh`` | the gear test rig with twelve coordinates |
| ``shafts`` | drives of shafts, discs and several meshes |
| ``force_law`` | contacts with a stiffness, a tangent or the whole force law |
| ``load_friction``, ``follow_load`` | friction that follows the load of the teeth |
"""
