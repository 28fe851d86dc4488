"""C3D, the binary format of optical marker systems since 1987."""

from app.adapters.captures.c3d.reader import read_c3d

__all__ = ["read_c3d"]
