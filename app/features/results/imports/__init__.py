"""Answers that were collected elsewhere: read, mapped, checked, taken in as a whole, undone."""
