"""Machines of a case file: tables, meshes as pair cases, load cases, results."""
