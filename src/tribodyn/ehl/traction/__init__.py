"""Traction of solved films, and their temperature.

| module | what it answers |
|---|---|
| ``traction`` | tangential forces of the oil on both surfaces |
| ``film_state`` | pressure and film of many contacts, as traction needs them |
| ``shear_models`` | shear stress of an oil, models by name, and its limit |
| ``newtonian``, ``ree_eyring``, ``bair_winer``, ``carreau``, ``carreau_eyring`` | these models |
| ``film_temperature`` | viscosity of warm oil, flash temperature, balance of heat |
| ``inlet_heating`` | thinner film by a heated inlet |
"""
