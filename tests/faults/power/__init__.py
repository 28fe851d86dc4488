"""Power loss, replayed from a record of what a server asked of its disk.

What is emulated: a disk that keeps its promise. What a completed fsync covers is there. Of what was
written since, every sector (512 or 4096 bytes) holds any of the versions it had, each sector for
itself, so writes reach the disk in any order and are torn; a file has any of the sizes it had; a
new name, a removed name or a new name for an old file is there or not until its folder was synced;
what was never written reads as zeros or as noise. The shared-memory index, which is rebuilt, is
gone or holds noise.

What is not: a disk that lies (says that a sync is done while data sit in a volatile cache), or that
damages sectors nobody wrote to.
"""
