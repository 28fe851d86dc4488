"""The command `reembody tune`: tune the avatar's motors, axis by axis."""
