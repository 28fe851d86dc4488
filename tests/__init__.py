"""Tests mirror `app/`; see `support/` for what they stand on."""
