"""Tests about the build itself: what is packed, how it is set up, what is never committed."""
