"""The command `reembody walk`: models of how people walk."""
