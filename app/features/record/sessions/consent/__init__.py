"""Consent: how it is given, stored and shown."""
