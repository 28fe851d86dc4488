"""Everything a session needs while it runs: ledger, sessions, devices, and the data they store."""
