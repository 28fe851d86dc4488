"""Fitted models of walking and their answers."""
