"""From a case to its result: tooth contact, structure, motion, figures, files."""
