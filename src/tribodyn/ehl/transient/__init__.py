"""The line contact over time: squeeze film, changing load, moving roughness.

| module | what it answers |
|---|---|
| ``transient`` | film over time |
| ``waviness`` | waves of a moving surface: the amplitude that the film keeps |
| ``moving_contact`` | series, scale and grid of the contact, and the state it starts from |
"""
