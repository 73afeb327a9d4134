"""The oil film along the path of contact.

The public names stand on the page of :mod:`tribodyn.mesh`.

| module | what it answers |
|---|---|
| ``film_columns`` | films by a formula, and the columns of a film |
| ``path_film`` | the film of the touching pairs: by formula, or solved at places |
| ``film_lookup`` | films from a table over load and speed, of slices and of many operating points |
| ``sheared_film`` | friction of slices that shear their film, from a table over load and place |
| ``film_refinement`` | where places are added until what lies between them is right |
"""
