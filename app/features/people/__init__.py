"""Who works here: accounts and the audit trail."""
