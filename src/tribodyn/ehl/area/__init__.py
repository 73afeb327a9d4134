"""Contacts over an area: points, ellipses and lines of finite length, solved in two dimensions.

| module | what it answers |
|---|---|
| ``area_case`` | a point or elliptical contact as the user gives it, its scales and its grid |
| ``multigrid`` | full multigrid with elastic films by FFT |
| ``point_contact`` | the solver of points and ellipses |
| ``solution`` | their results and friction, and whether the infinite line is enough |
| ``finite_line`` | the solver of rollers of finite length, and their profiles |
"""
