"""Readers of recordings; the format is detected from the content of a file, not only its name.

| module | files |
|---|---|
| ``detect_format`` | detection of the format and choice of the reader |
| ``recording_data`` | data that every reader returns; sampling rate of evenly spaced times |
| ``text`` | CSV and other columns of numbers |
| ``profile_map`` | measured deviations of flanks, from CSV files |
| ``binary`` | WAV, UFF 58, TDMS, MAT of versions 4 to 7.3, HDF5 and netCDF |
"""
