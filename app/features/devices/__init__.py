"""Pairing tablets and headsets."""
