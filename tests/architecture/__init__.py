"""Tests of the build: package contents, set-up, and files that must never be committed."""
