"""The law that is marched: data of a structure, its rows on the mesh phase, its motion.

| module | what it answers |
|---|---|
| `system` | What is a structure with its contacts and frictions? |
| `grid` | How is the mesh cycle divided so that no step spans a jump? |
| `nodes` | What are the entries at both ends and in the middle of every step? |
| `alike` | What are the entries of many systems that differ in values alone? |
| `motion` | What forces and accelerations follow from a motion? The law, readable. |
| `program` | In which flat arrays do the kernels read the law? |
| `lane_parameters` | By which factors do lanes of an ensemble differ? |
| `compiled` | What is a system, or one for each lane, on its grid? |
| `step_limit` | How long may a step be? |
| `divergence` | What is said of a march that failed, and why did it? |
"""
