"""The command `reembody reach`: learn from recorded hands how people reach."""
