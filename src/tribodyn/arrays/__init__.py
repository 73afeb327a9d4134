"""Functions of arrays that any part may use.

| module | what it answers |
|---|---|
| ``monotone`` | cubics through points that swing beyond none of them |
| ``recent`` | the last values of a function of arrays, found by what is in them |
"""
