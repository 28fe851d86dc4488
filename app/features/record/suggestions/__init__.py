"""Suggestions of experts about a study, and the decisions on them."""
