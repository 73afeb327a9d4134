"""Functions of arrays that any package may use.

| module | content |
|---|---|
| ``cubic`` | cubic splines: with prescribed slopes, or with continuous curvature |
| ``eigenvectors`` | signs and bases of eigenvectors that rounding does not choose |
| ``memo`` | cache of the last values of a function of arrays, by their content |
| ``monotone`` | monotone cubics, which do not overshoot |
| ``products`` | products of a small matrix and many vectors |
| ``workspace`` | work arrays that are reused from call to call |
"""
