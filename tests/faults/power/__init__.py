"""Replay power losses from a trace of a server's disk calls.

Emulated is a disk that keeps its promises. Data covered by a completed fsync are there. Of data
written since, every sector (512 or 4096 bytes) independently holds any of the versions it had, so
writes reach the disk in any order and are torn; a file has any of the sizes it had; a new name, a
removed name or a new name for an old file exists or not until its folder is synced; parts that were
never written read as zeros or as noise. The shared-memory index, which is rebuilt, is missing or
contains noise.

Not emulated is a disk that lies (reports a completed sync while data are in a volatile cache), or
that damages sectors that were not written to.
"""
