"""Following a path: speed along it, and the metrics of a walk."""
