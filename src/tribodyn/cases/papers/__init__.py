"""Printed tables of the sources beside what is computed here.

| Module | What it answers |
|---|---|
| `printed` | what a source prints, row by row, and how near computed figures are |
| `computations` | which figures of a case there are to lay beside it, by name |
| `jobs` | which computations a page takes, each done once |
| `comparison` | all rows of some sources, their table and their page |
"""
