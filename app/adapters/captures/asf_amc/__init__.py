"""Acclaim's pair of files: ASF contains a skeleton, AMC its movement."""

from app.adapters.captures.asf_amc.reader import read_asf_amc

__all__ = ["read_asf_amc"]
