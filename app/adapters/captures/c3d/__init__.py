"""C3D: the binary file of marker systems since 1987."""

from app.adapters.captures.c3d.reader import read_c3d

__all__ = ["read_c3d"]
