"""The system calls that change files or send data, with their numbers.

An opening is traced only if it may create or empty a file; a closing is never traced, since it does
not change the contents of a disk.
"""

import platform
from dataclasses import dataclass

AUDIT_ARCH = {"x86_64": 0xC000003E, "aarch64": 0xC00000B7}
NUMBERS = {
    "x86_64": {
        "write": 1,
        "pwrite64": 18,
        "writev": 20,
        "pwritev": 296,
        "pwritev2": 328,
        "sendto": 44,
        "sendmsg": 46,
        "fsync": 74,
        "fdatasync": 75,
        "truncate": 76,
        "ftruncate": 77,
        "open": 2,
        "creat": 85,
        "openat": 257,
        "rename": 82,
        "renameat": 264,
        "renameat2": 316,
        "unlink": 87,
        "unlinkat": 263,
        "link": 86,
        "linkat": 265,
        "fallocate": 285,
        "sendfile": 40,
        "copy_file_range": 326,
        "splice": 275,
        "sendmmsg": 307,
    },
    "aarch64": {
        "write": 64,
        "pwrite64": 68,
        "writev": 66,
        "pwritev": 70,
        "pwritev2": 287,
        "sendto": 206,
        "sendmsg": 211,
        "fsync": 82,
        "fdatasync": 83,
        "truncate": 45,
        "ftruncate": 46,
        "openat": 56,
        "renameat": 38,
        "renameat2": 276,
        "unlinkat": 35,
        "linkat": 37,
        "fallocate": 47,
        "sendfile": 71,
        "copy_file_range": 285,
        "splice": 76,
        "sendmmsg": 269,
    },
}
OPEN_FLAGS_AT = {"open": 1, "openat": 2}
"""The index of the argument with the flags."""
O_CREAT, O_TRUNC = 0o100, 0o1000
AT_FDCWD = -100
AT_REMOVEDIR = 0x200


@dataclass(frozen=True)
class Machine:
    """The kernel's numbers for system calls on this processor."""

    audit_arch: int
    number: dict[str, int]

    @property
    def name(self) -> dict[int, str]:
        """Return the names of the calls, keyed by number."""
        return {number: name for name, number in self.number.items()}


def this_machine() -> Machine | None:
    """Return the numbers for the current machine, or None if its calls are not listed."""
    kind = platform.machine()
    if platform.system() != "Linux" or kind not in NUMBERS:
        return None
    return Machine(AUDIT_ARCH[kind], NUMBERS[kind])
