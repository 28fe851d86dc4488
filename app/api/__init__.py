"""Putting the routes together: routers, the error handler, the guards in front."""
