"""Traction of solved films, and their temperature.

| module | what it answers |
|---|---|
| ``traction`` | tangential forces of the oil on both surfaces |
| ``film_state`` | pressure and film of many contacts, as traction needs them |
| ``shear_models`` | shear stress of an oil by name: Newton, Ree-Eyring, Carreau, Bair-Winer |
| ``film_temperature`` | viscosity of warm oil, flash temperature, balance of heat, heated inlet |
"""
