"""A client of the public interfaces: HTTP, and the WebSocket with its journal."""
