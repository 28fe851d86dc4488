"""Benchmarks for `./run bench NAME [--json]`: figures with the machine, and a limit or a peer."""
