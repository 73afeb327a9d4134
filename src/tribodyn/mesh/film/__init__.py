"""The oil film along the path of contact.

The public names stand on the page of :mod:`tribodyn.mesh`.

| module | what it answers |
|---|---|
| ``loaded_contacts`` | what contacts of any teeth state that share a load through their films |
| ``film_columns`` | films by a formula, and the columns of a film |
| ``path_film`` | the film of the touching pairs: by formula, or solved at places |
| ``film_lookup`` | films from a table over load and speed, of slices and of many operating points |
| ``sheared_film`` | friction and heat of slices and cells, from a table over load and place |
| ``film_table`` | values between solved contacts: an interpolated table, or fitted polynomials |
| ``film_refinement`` | where places are added until what lies between them is right |
"""
