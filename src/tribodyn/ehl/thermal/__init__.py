"""The heated film of a line contact: temperatures, shear across the film, and friction.

| module | what it answers |
|---|---|
| ``thermal_model`` | how the oil shears and what of heat a contact needs |
| ``surfaces`` | how warm the moving surfaces become by the heat that they take up |
| ``surface_history`` | how warm they become by a heat that changes over time |
| ``thermal_contact`` | pressure, film and temperatures together |
| ``thermal_solution`` | the result: temperatures, friction, and the balance of heat |
"""
