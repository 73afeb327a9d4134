"""The case file: its tables and keys, how they are read, checked, completed and written."""
