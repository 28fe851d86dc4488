"""Measurements: `./run bench NAME [--json]`; figures come with machine, ratio and peer."""
