"""Traction of solved films, and their temperature.

| module | what it answers |
|---|---|
| ``traction`` | pressure and film of many contacts, tangential forces on both surfaces |
| ``shear_models`` | shear stress of an oil by name: Newton, Ree-Eyring, Carreau, Bair-Winer |
| ``film_temperature`` | viscosity of warm oil, flash temperature, balance of heat, heated inlet |
"""
