"""Tests mirror `app/`; `support/` contains their infrastructure."""
