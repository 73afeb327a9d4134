"""Printed tables and claims of the sources, compared with computed figures.

| Module | What it answers |
|---|---|
| `printed` | what a source prints, row by row, and how close computed figures are |
| `computations` | which figures of a case can be compared, by name |
| `jobs` | which computations a page needs, each done once |
| `comparison` | all rows of some sources, their table and their page |
| `friction_experiment` | what friction changes in a running pair, all other values held constant |
| `friction_claims` | verdicts of the experiment on claims of five sources |
"""
