"""Batches of variants of one case, and data sets for learned models.

| module | what it answers |
|---|---|
| ``lanes`` | which variants share a tooth contact, and by which factors they differ |
| ``cycles`` | one mesh cycle of the steady motion of every variant |
| ``ensemble`` | what spread inputs do to forces and motion, with bands |
| ``sensitivity`` | which tolerance the spread of a figure comes from |
| ``data_set`` | a table of rows with its origin |
| ``vibration_data`` | rows over time or over the mesh cycle of repeated runs |
| ``operating_data`` | one row for each operating point |
"""
