"""Static balance of a machine.

| module | content |
| --- | --- |
| `balance` | deflections, mesh forces, bearing loads and misalignment under the torque |
| `static_model` | coordinates, and the laws of meshes and bearings |
| `face_law` | mesh force over the face width by independent slices |
"""
