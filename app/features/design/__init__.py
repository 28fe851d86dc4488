"""What a study consists of: its versions and its instruments."""
