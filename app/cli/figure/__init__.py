"""The command `figure`: make a skinned body for anybody's proportions."""
