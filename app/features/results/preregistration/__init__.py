"""Preregistration: what a study declared, what was done, and every deviation between the two."""
