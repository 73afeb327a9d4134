"""Film formulas of the line contact, by author.

| module | what it answers |
|---|---|
| ``dimensionless_groups`` | which numbers describe a contact, and its regime after Moes |
| ``elliptical`` | film of elliptical contacts: Hamrock and Dowson |
| ``power_laws`` | film in the elastic-piezoviscous regime: Dowson, Dowson-Toyoda, Pan-Hamrock |
| ``moes`` | central film in all regimes, and how it follows the load |
"""
