"""Readers of recordings: what a file is is told by its content, not by its name alone.

| module | files |
|---|---|
| ``recognised`` | which reader a file needs |
| ``content`` | what every reader gives; whether times are evenly spaced |
| ``text`` | CSV and other columns of numbers |
| ``binary`` | WAV, UFF 58, TDMS, MAT of versions 4 to 7.3, HDF5 and netCDF |
"""
