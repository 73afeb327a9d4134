"""The engines: private, reached through `tribodyn.dynamics.time`.

| module | what it answers |
|---|---|
| `lanes` | How does compiled code add and multiply one number per trajectory? |
| `contact_forces` | What forces and accelerations follow from a motion? The law, compiled. |
| `method` | What does a method of fixed steps give, and how is it chosen? |
| `runge_kutta`, `newmark` | How does one step of the method go? |
| `dormand_prince` | How does one adaptive step go, how wrong is it, what is between its ends? |
| `crossing` | When within a step does a contact open or close? |
| `statistics` | What is gathered of lanes, and the same sums of recorded motions? |
| `moments`, `middle` | How is it gathered while marching, and what does a step leave for it? |
| `marching` | How does a block of lanes march in the steps of the grid? |
| `adaptive` | How does it march in steps of its own length? |
| `blocks` | How are lanes spread over blocks and threads, and what is said of a failure? |
| `adaptive_engine` | The same for adaptive steps: tolerances, blocks and failures. |
| `phase_table` | What are the entries between events, as polynomials of the mesh phase? |
"""
