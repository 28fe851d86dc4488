"""Running a session: its event log, its state, its commands."""
