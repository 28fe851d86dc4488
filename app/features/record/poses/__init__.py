"""Live poses of a running session for the console, always the latest and never a backlog."""
