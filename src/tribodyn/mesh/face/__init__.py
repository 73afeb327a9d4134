"""Meshes whose contacts are slices of lines: pairs as a whole, maps over path and face.

| module | content |
|---|---|
| ``lines`` | columns of whole tooth pairs from those of their slices |
| ``operation`` | films over the flank for many torques and speeds |
| ``maps`` | values over the path of contact and the face width; face load factor |
"""
