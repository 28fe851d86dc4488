"""What others do with the same frames, measured beside ours in the same run."""
