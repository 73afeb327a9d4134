"""Readers of recordings: what a file is is told by its content, not by its name alone.

| module | files |
|---|---|
| ``recognised`` | which reader a file needs |
| ``content`` | what every reader gives; whether times are evenly spaced |
| ``text`` | CSV and other columns of numbers |
| ``matlab`` | MAT, versions 4 to 7.3 |
| ``binary`` | WAV, UFF 58, TDMS, HDF5 and netCDF |
"""
