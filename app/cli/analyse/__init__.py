"""The command `reembody analyse`: statistical tests on any tidy table."""
