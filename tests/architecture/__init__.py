"""Tests of the build: what is packaged, how it is set up, what must never be committed."""
