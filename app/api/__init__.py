"""Assemble the HTTP interface: routes, error handlers, guards."""
