"""The tablet: what it shows, what it sends."""
