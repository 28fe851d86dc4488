"""Configurations of avatars: named, versioned, imported and exported."""
