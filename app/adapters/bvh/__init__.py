"""BVH motion capture (Biovision Hierarchy): read and write it, and compute world positions."""

from app.adapters.bvh.clip import BvhClip, BvhError, BvhLimits
from app.adapters.bvh.reader import parse_bvh, parse_bvh_lines, read_bvh
from app.adapters.bvh.writer import format_bvh

__all__ = [
    "BvhClip",
    "BvhError",
    "BvhLimits",
    "format_bvh",
    "parse_bvh",
    "parse_bvh_lines",
    "read_bvh",
]
