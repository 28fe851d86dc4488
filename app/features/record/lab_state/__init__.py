"""The state of the lab for its first page: progress, today's sessions, what needs attention."""
