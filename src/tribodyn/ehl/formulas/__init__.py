"""Film formulas of the line contact, by author.

| module | what it answers |
|---|---|
| ``dimensionless_groups`` | which numbers describe a contact, and its regime after Moes |
| ``line`` | Dowson, Dowson-Toyoda, Pan-Hamrock; Moes in all regimes, and how it follows the load |
| ``elliptic`` | films of points and ellipses: Nijenbanning in all regimes, Hamrock-Dowson |
"""
