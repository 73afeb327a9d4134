"""Printed tables of the sources, compared with computed figures.

| Module | What it answers |
|---|---|
| `printed` | what a source prints, row by row, and how close computed figures are |
| `computations` | which figures of a case can be compared, by name |
| `jobs` | which computations a page needs, each done once |
| `comparison` | all rows of some sources, their table and their page |
"""
