"""Static balance of a machine.

| module | content |
| --- | --- |
| `balance` | deflections, mesh forces, bearing loads and misalignment under the torque |
| `static_model` | coordinates, and the laws of meshes and bearings |
| `least_load` | stiffness of rolling bearings that carry less than a weight |
| `face_law` | mesh force over the face width by independent slices |
"""
