"""The command `figure`: make a skinned body with the proportions of any person."""
