"""The heated film of a line contact: temperatures, shear across the film, and friction.

| module | what it answers |
|---|---|
| ``thermal_model`` | how the oil shears and what of heat a contact needs |
| ``surface_history`` | how warm the moving surfaces become by a heat, steady or not |
| ``thermal_contact`` | pressure, film and temperatures together |
"""
