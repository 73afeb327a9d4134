"""The oil: viscosity and density over pressure and temperature, and a library of named oils.

| module | content |
| --- | --- |
| `oil` | a lubricating oil at its working temperature |
| `library` | named oils, each number with its source |
| `data_sheet` | an oil of a data sheet: two viscosities, or one and a viscosity index |
| `astm` | viscosity over temperature from two points (D341); viscosity index, and back (D2270) |
| `pressure_laws` | viscosity (Barus, Roelands) and density under pressure and temperature |
"""

from tribodyn.arguments.pages import public_page

__all__, __getattr__, __dir__ = public_page(__name__, __file__)
