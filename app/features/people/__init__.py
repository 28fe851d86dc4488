"""The lab's staff: their accounts, and the audit trail of their actions."""
