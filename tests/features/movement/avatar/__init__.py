"""Tests of configurations of avatars."""
