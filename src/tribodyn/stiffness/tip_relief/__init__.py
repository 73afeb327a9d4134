"""Transmission error at rest over torque, and the tip relief that leaves least of it.

| module | what it answers |
| --- | --- |
| `harris` | static transmission error over phase and torque |
| `lead` | which crowning and slope over the face spread the load most evenly |
| `minimum` | least point of an objective over amount and length |
| `search` | which amount and length of tip relief is best over torques, and the map of all |
"""
