"""What the operator has to know now: raised, cleared, and kept."""
