"""What happens while a study runs: the ledger, sessions, their devices, and all they store."""
