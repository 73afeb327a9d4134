"""Printed tables of the sources beside what is computed here.

| Module | What it answers |
|---|---|
| `printed` | what a source prints, row by row: the files in ``cases/reference`` |
| `computations` | which figures of a case there are to lay beside it, by name |
| `jobs` | which computations a page takes, each done once |
| `verdict` | how near computed figures are to the printed ones |
| `comparison` | all rows of some sources, their table and their page |
"""
