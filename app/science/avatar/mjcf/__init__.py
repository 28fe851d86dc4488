"""The body and its configuration as one MuJoCo model."""
