"""Functions of arrays that any package may use.

| module | content |
|---|---|
| ``linear_algebra`` | products with many vectors; signs and bases of eigenvectors |
| ``memory`` | cache of the last values of a function by its arrays; reused work arrays |
| ``splines`` | cubics with given slopes, monotone cubics, B-splines |
"""
