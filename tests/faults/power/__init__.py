"""Replay power losses from a trace of a server's disk calls.

The emulated disk keeps its promises: data covered by a completed fsync exist. In data written since
then, each sector (512 or 4096 bytes) independently contains any of its versions, so writes reach
the disk in any order and are torn; a file has any of the sizes it had; a new name, a removed name
or a new name for an old file exists or not until its folder is synced; parts that were never
written read as zeros or as noise. The shared-memory index, which is rebuilt, is missing or contains
noise.

Not emulated are disks that lie (report a completed sync while data are in a volatile cache), or
that damage sectors that were not written to.
"""
