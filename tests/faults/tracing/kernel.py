"""Call the kernel's tracing interface through the C library: ptrace(2) and seccomp(2).

Numbers are from the kernel's headers `ptrace.h`, `seccomp.h`, `prctl.h` and `bpf_common.h`.
"""

import ctypes
import os
from collections.abc import Iterator
from dataclasses import dataclass

from tests.faults.tracing.calls import O_CREAT, O_TRUNC, OPEN_FLAGS_AT, Machine

SEIZE, CONT, SYSCALL, LISTEN, GET_SYSCALL_INFO = 0x4206, 7, 24, 0x4208, 0x420E
EVENT_SECCOMP, EVENT_STOP = 7, 128
OPTIONS = 0x1 | 0x2 | 0x4 | 0x8 | 0x10 | 0x80 | 0x100000
"""Mark system call stops; follow fork, vfork, clone, exec; seccomp stops; end with the tracer."""
INFO_ENTRY, INFO_EXIT, INFO_SECCOMP = 1, 2, 3
WALL = 0x40000000
PR_SET_SECCOMP, PR_SET_NO_NEW_PRIVS, MODE_FILTER = 22, 38, 2
RET_TRACE, RET_ALLOW = 0x7FF00000, 0x7FFF0000
LOAD, JUMP_EQUAL, JUMP_ANY_BIT, RETURN = 0x20, 0x15, 0x45, 0x06

libc = ctypes.CDLL(None, use_errno=True)
libc.ptrace.argtypes = (ctypes.c_long, ctypes.c_int, ctypes.c_void_p, ctypes.c_void_p)
libc.ptrace.restype = ctypes.c_long
libc.prctl.argtypes = (ctypes.c_int, *[ctypes.c_ulong] * 4)


class _Info(ctypes.Structure):
    _fields_ = (
        ("op", ctypes.c_uint8),
        ("_pad", ctypes.c_uint8 * 3),
        ("arch", ctypes.c_uint32),
        ("instruction_pointer", ctypes.c_uint64),
        ("stack_pointer", ctypes.c_uint64),
        ("values", ctypes.c_uint64 * 8),
    )


class _Instruction(ctypes.Structure):
    _fields_ = (
        ("code", ctypes.c_uint16),
        ("jump_if", ctypes.c_uint8),
        ("jump_else", ctypes.c_uint8),
        ("k", ctypes.c_uint32),
    )


class _Program(ctypes.Structure):
    _fields_ = (("length", ctypes.c_ushort), ("instructions", ctypes.POINTER(_Instruction)))


@dataclass(frozen=True)
class Stop:
    """A stop at a system call: `values` are its number and arguments, or its result on return."""

    at_exit: bool
    values: tuple[int, ...]


def changes() -> Iterator[tuple[int, int]]:
    """Yield every thread that stops or ends, with its status, until none is left."""
    while True:
        try:
            change = os.waitpid(-1, WALL)
        except ChildProcessError:
            return
        yield change


def ptrace(request: int, thread: int, address: int = 0, data: int = 0) -> int:
    """Make one ptrace request.

    Raises OSError on failure, and ProcessLookupError if the thread was killed meanwhile.
    """
    ctypes.set_errno(0)
    answer: int = libc.ptrace(request, thread, address, data)
    if answer == -1 and ctypes.get_errno():
        raise OSError(ctypes.get_errno(), f"ptrace request {request:#x} was refused")
    return answer


def stop_of(thread: int) -> Stop:
    """Return the system call at which a thread has stopped."""
    info = _Info()
    ptrace(GET_SYSCALL_INFO, thread, ctypes.sizeof(info), ctypes.addressof(info))
    if info.op == INFO_EXIT:
        result = ctypes.c_int64(info.values[0]).value
        return Stop(at_exit=True, values=(result,))
    return Stop(at_exit=False, values=tuple(info.values[:7]))


def read_memory(thread: int, address: int, length: int) -> bytes:
    """Return bytes of the traced process's memory, or fewer if the memory ends before."""
    file = os.open(f"/proc/{thread}/mem", os.O_RDONLY)
    try:
        return os.pread(file, length, address)
    finally:
        os.close(file)


def only_stop_at(machine: Machine, *, every_opening: bool = False) -> None:
    """Restrict the stops of this process and its children to the watched calls, permanently.

    `every_opening`: also stop at openings that neither create a file nor empty it. Raises OSError.
    A process with this filter needs its tracer: without one those calls fail.
    """
    program = _program(machine, every_opening=every_opening)
    array = (_Instruction * len(program))(*program)
    packed = _Program(len(program), array)
    _require(libc.prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0))
    _require(libc.prctl(PR_SET_SECCOMP, MODE_FILTER, ctypes.addressof(packed), 0, 0))


def _require(answer: int) -> None:
    if answer != 0:
        raise OSError(ctypes.get_errno(), "the kernel does not take a filter of system calls")


def _program(machine: Machine, *, every_opening: bool) -> list[_Instruction]:
    """Return the filter: other architectures pass, and each watched number stops."""
    arch_at, number_at, arguments_at = 4, 0, 16
    lines = [
        _Instruction(LOAD, 0, 0, arch_at),
        _Instruction(JUMP_EQUAL, 1, 0, machine.audit_arch),
        _Instruction(RETURN, 0, 0, RET_ALLOW),
        _Instruction(LOAD, 0, 0, number_at),
    ]
    for name, number in machine.number.items():
        if name in OPEN_FLAGS_AT and not every_opening:
            flags_at = arguments_at + 8 * OPEN_FLAGS_AT[name]
            lines += [
                _Instruction(JUMP_EQUAL, 0, 4, number),
                _Instruction(LOAD, 0, 0, flags_at),
                _Instruction(JUMP_ANY_BIT, 0, 1, O_CREAT | O_TRUNC),
                _Instruction(RETURN, 0, 0, RET_TRACE),
                _Instruction(RETURN, 0, 0, RET_ALLOW),
            ]
        else:
            lines += [
                _Instruction(JUMP_EQUAL, 0, 1, number),
                _Instruction(RETURN, 0, 0, RET_TRACE),
            ]
    return [*lines, _Instruction(RETURN, 0, 0, RET_ALLOW)]
