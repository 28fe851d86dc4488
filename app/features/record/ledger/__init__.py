"""Joining: participants and the counterbalancing ledger."""
