"""Tests of the platform that every feature stands on."""
