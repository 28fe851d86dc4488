"""The command `reembody crossing`: co-simulated scenes at a road."""
