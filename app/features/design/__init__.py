"""What a study is made of: its versions and its instruments."""
