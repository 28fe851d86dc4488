"""What experts advise about a study, and what became of it."""
