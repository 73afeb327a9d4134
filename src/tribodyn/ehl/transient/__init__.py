"""The line contact over time: squeeze film, changing load, moving roughness.

| module | what it answers |
|---|---|
| ``transient`` | film over time |
| ``heated_steps`` | film and temperatures over time, step by step |
| ``solution`` | the result, isothermal or heated |
| ``waviness`` | waves of a moving surface: the amplitude that the film keeps |
| ``moving_contact`` | series, scale and grid of the contact, and the state it starts from |
"""
