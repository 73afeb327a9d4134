"""Hypoid and spiral bevel pairs: blank, flanks, and where they touch.

| module | what it answers |
| --- | --- |
| `pitch_cones` | the cones that touch in the calculation point |
| `dimensions` | all dimensions of both blanks that follow from them |
| `blank` | a pair of blanks from the figures of a drawing |
"""

from tribodyn.gear.hypoid.blank import HypoidBlank, hypoid_blank

__all__ = ["HypoidBlank", "hypoid_blank"]
