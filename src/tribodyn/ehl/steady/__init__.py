"""The steady line contact, solved.

| module | what it answers |
|---|---|
| ``line_contact`` | pressure and film of one contact |
| ``batch`` | films of many contacts at once |
| ``solution`` | the result: pressure, film and their errors |
| ``contact_case`` | is what the user gave a contact, and what are its dimensionless numbers |
| ``grid`` | how far the grid reaches, the inlet before it, and how many nodes it has |
| ``contact_problem`` | problem and outcome of an engine |
| ``engines`` | the two engines: Newton and multigrid |
| ``fallbacks`` | verification of solutions, and the fallbacks when an engine fails |
"""
