"""Planetary stages of a case file: tables, meshes as pair cases, motion, figures."""
