"""The design of a study: its versions and its instruments."""
