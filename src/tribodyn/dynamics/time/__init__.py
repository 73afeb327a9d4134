"""Motion over time: single trajectories, ensembles, and what is read off them.

| module | what it answers |
|---|---|
| `simulate` | How does a system move from a given start? |
| `ensemble` | How do many trajectories move, and what are their statistics? |
| `engines` | Which engines can a case choose, and how do they march lanes on? |
| `newmark` | Which parameters does Newmark's scheme have, and which steps are too long? |
| `adaptive_solution` | How does a system move, to a tolerance, at any time? |
| `response` | What are forces, accelerations and means along a motion, and where a contact opens? |
| `energy` | Does the energy of a motion add up? |
"""
