"""How the columns of a chunk are written as bytes: one module an encoding, named by `NAME`."""
