"""What comes of the record: analyses, exports, replay, declared tests, imported answers."""
