"""`reembody tune`: the avatar's motors, axis by axis."""
