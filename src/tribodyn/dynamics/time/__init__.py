"""Motion over time: single trajectories, ensembles, and what is read off them.

| module | what it answers |
|---|---|
| `simulate` | How does a system move from a given start? |
| `ensemble` | How do many trajectories move, and what are their statistics? |
| `engines` | Which engines are there, and how do they march lanes on? |
| `newmark` | Which parameters does Newmark's scheme have, and which steps are too long? |
| `adaptive_solution` | How does a system move, to a tolerance, at any time? |
| `response` | What are forces, accelerations and means along a motion? |
| `response_crossings` | What are they where a contact opens or closes? |
| `recorded` | What are the statistics of recorded lanes? |
| `energy` | Does the energy of a motion add up? |
"""
