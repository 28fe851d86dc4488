"""Benchmarks: `./run bench NAME [--json]`; figures come with the machine, a ratio and a peer."""
