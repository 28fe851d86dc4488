"""The network view of the console: how devices reach this server."""
