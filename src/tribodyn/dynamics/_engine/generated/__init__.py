"""Straight-line kernels of one structure, and lanes that march on a graphics processor.

| module | what it answers |
|---|---|
| `source` | How do the forces and the step of one structure read as straight lines of code? |
| `thread` | How does one thread march one trajectory? |
| `cuda` | How do the threads of a graphics processor march all lanes? |
"""
