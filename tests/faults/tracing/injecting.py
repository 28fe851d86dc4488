"""Make one system call of a traced process fail, as a broken or full disk would.

The process is stopped before the call; the number of the call is removed, so that the kernel skips
it, and the error is put in place of its result. Calls to files in one folder are counted after the
process opens the file `BEGIN` there.
"""

import ctypes
import os
import platform
import re
import signal
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from tests.faults.tracing import kernel
from tests.faults.tracing.calls import AT_FDCWD, Machine, this_machine
from tests.faults.tracing.decode import path_of, target_of

BEGIN = ".io-faults-begin"
CALLS = {
    "read": 0,
    "pread64": 17,
    "open": 2,
    "openat": 257,
    "write": 1,
    "pwrite64": 18,
    "fsync": 74,
    "fdatasync": 75,
    "ftruncate": 77,
    "rename": 82,
    "renameat": 264,
    "renameat2": 316,
    "unlink": 87,
    "unlinkat": 263,
    "mkdir": 83,
    "mkdirat": 258,
}
"""The call numbers of x86-64, without reading a folder, stat, locks and memory maps."""
_KIND = {
    "pread64": "read",
    "openat": "open",
    "pwrite64": "write",
    "fdatasync": "fsync",
    "ftruncate": "truncate",
    "renameat": "rename",
    "renameat2": "rename",
    "unlinkat": "unlink",
    "mkdirat": "mkdir",
}
_WITH_FOLDER = {"openat", "unlinkat", "mkdirat", "renameat", "renameat2"}
_BY_PATH = _WITH_FOLDER | {"open", "unlink", "mkdir", "rename"}
_FLAGS_AT = {"open": 1, "openat": 2}
_GET_REGISTERS, _SET_REGISTERS = 12, 13
_REGISTERS, _RESULT, _NUMBER = 27, 10, 15
"""`struct user_regs_struct`: its length, and the indices of rax and orig_rax."""
_DRAWN = re.compile(r"[0-9a-f]{6,}|\d{2,}|(?<=-)[a-z0-9_]{8}(?=/|$)|(?<=\.)[a-z0-9_]{8}(?=\.)")


@dataclass(frozen=True)
class Site:
    """A call to a file: the kind of call, the file, and how many such calls came before.

    `path` is relative to the folder, with `*` for random or dated parts. `writes`: whether an open
    call is for writing.
    """

    kind: str
    path: str
    nth: int
    writes: bool = False


@dataclass(frozen=True)
class Fault:
    """A call at `site` that fails with `errno`."""

    site: Site
    errno: int


@dataclass
class Injector:
    """Follow a process, record its calls to files in `folder`, and make one call fail."""

    machine: Machine
    folder: Path
    fault: Fault | None = None
    sites: list[Site] = field(default_factory=list)
    hit: bool = False
    _counts: Counter[tuple[str, str, bool]] = field(default_factory=Counter)
    _begun: bool = False

    def follow(self, child: int) -> int:
        """Follow until all processes have ended; return the exit code, negative for a signal."""
        code = 0
        for thread, status in kernel.changes():
            if os.WIFSTOPPED(status):
                self._go_on(thread, status)
            elif thread == child:
                code = os.waitstatus_to_exitcode(status)
        return code

    def _go_on(self, thread: int, status: int) -> None:
        number, event = os.WSTOPSIG(status), status >> 16
        request, deliver = kernel.CONT, 0
        try:
            if event == kernel.EVENT_SECCOMP:
                self._enter(thread)
            elif event == kernel.EVENT_STOP:
                stopped = number in (signal.SIGSTOP, signal.SIGTSTP, signal.SIGTTIN, signal.SIGTTOU)
                request = kernel.LISTEN if stopped else kernel.CONT
            elif event == 0:
                deliver = number
            kernel.ptrace(request, thread, 0, deliver)
        except ProcessLookupError:
            return

    def _enter(self, thread: int) -> None:
        number, *arguments = kernel.stop_of(thread).values
        asked = self._asked(thread, self.machine.name[number], arguments)
        if asked is None:
            return
        kind, path, writes = asked
        if path == BEGIN:
            self._begun = True
        elif self._begun:
            at = self._counts[asked]
            self._counts[asked] += 1
            site = Site(kind, path, at, writes)
            self.sites.append(site)
            if self.fault is not None and site == self.fault.site and not self.hit:
                self.hit = True
                fail(thread, self.fault.errno)

    def _asked(
        self, thread: int, call: str, arguments: Sequence[int]
    ) -> tuple[str, str, bool] | None:
        """Return a call's kind, file and whether it writes; None for calls outside the folder."""
        if call in _BY_PATH:
            at = call in _WITH_FOLDER
            path = path_of(thread, arguments[0] if at else AT_FDCWD, arguments[1 if at else 0])
        else:
            path = target_of(thread, arguments[0])
        if not path.startswith(f"{self.folder}/"):
            return None
        writes = call in _FLAGS_AT and bool(arguments[_FLAGS_AT[call]] & (os.O_WRONLY | os.O_RDWR))
        inside = path.removeprefix(f"{self.folder}/").removesuffix(" (deleted)")
        return _KIND.get(call, call), _DRAWN.sub("*", inside), writes


def fail(thread: int, errno: int) -> None:
    """Skip the call that a stopped thread is about to make, and return this error from it."""
    registers = (ctypes.c_ulonglong * _REGISTERS)()
    kernel.ptrace(_GET_REGISTERS, thread, 0, ctypes.addressof(registers))
    registers[_NUMBER] = ctypes.c_ulonglong(-1).value
    registers[_RESULT] = ctypes.c_ulonglong(-errno).value
    kernel.ptrace(_SET_REGISTERS, thread, 0, ctypes.addressof(registers))


def injecting_machine() -> Machine | None:
    """Return the calls that can be made to fail here; None if they are unknown."""
    machine = this_machine()
    if machine is None or platform.machine() != "x86_64":
        return None
    return Machine(machine.audit_arch, CALLS)


def followed(injector: Injector, work: Callable[[], int]) -> int:
    """Run `work` in a child under the injector and return its exit code.

    Raises OSError if tracing is not allowed. Call it in a process that has no other children.
    """
    gate, opener = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(opener)
        code = 70
        try:
            os.read(gate, 1)
            kernel.only_stop_at(injector.machine, every_opening=True)
            code = work()
        finally:
            os._exit(code)
    os.close(gate)
    try:
        kernel.ptrace(kernel.SEIZE, child, 0, kernel.OPTIONS)
    except OSError:
        os.kill(child, signal.SIGKILL)
        raise
    os.write(opener, b"!")
    os.close(opener)
    return injector.follow(child)
