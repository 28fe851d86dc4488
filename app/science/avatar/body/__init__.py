"""The body: its 52 parts, proportions, masses and shapes."""
