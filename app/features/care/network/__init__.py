"""How devices reach this server, for the console."""
