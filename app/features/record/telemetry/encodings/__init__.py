"""The encodings of a chunk's columns as bytes: one module per encoding, named by its `NAME`."""
