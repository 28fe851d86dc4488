"""The records that the parts exchange."""
