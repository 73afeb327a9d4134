"""Functions of arrays that any part may use.

| module | what it answers |
|---|---|
| ``cubic`` | cubics through points, with slopes given or with steady bends |
| ``kept`` | memory that lasts from one use to the next |
| ``monotone`` | cubics through points that swing beyond none of them |
| ``products`` | products of a small matrix and many vectors |
| ``recent`` | the last values of a function of arrays, found by what is in them |
"""
