"""Run a command under ptrace and handle every stop of every thread, one at a time.

A stopped thread continues only after its stop was recorded. So an action that one thread takes
because of another's system call gets the later stamp.
"""

import os
import signal
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import BinaryIO

from tests.faults.tracing import kernel
from tests.faults.tracing.calls import Machine, this_machine
from tests.faults.tracing.decode import Reader
from tests.faults.tracing.events import Event, write_event

REFUSED = 77
"""The exit code if the kernel does not allow tracing; standard error says why."""
SYSCALL_STOP = signal.SIGTRAP | 0x80
GROUP_STOPS = (signal.SIGSTOP, signal.SIGTSTP, signal.SIGTTIN, signal.SIGTTOU)


@dataclass
class Tracer:
    """Trace one command and all its child processes."""

    machine: Machine
    reader: Reader
    output: BinaryIO
    _stamp: int = 0
    _begun: dict[int, Event] = field(default_factory=dict)

    def follow(self, child: int) -> int:
        """Follow until all processes have ended; return the exit code, negative for a signal."""
        code = 0
        for thread, status in kernel.changes():
            if os.WIFSTOPPED(status):
                self._go_on(thread, status)
                continue
            self._write(self._begun.pop(thread, None))
            if thread == child:
                code = os.waitstatus_to_exitcode(status)
        return code

    def _go_on(self, thread: int, status: int) -> None:
        """Handle a stop and let the thread continue."""
        number, event = os.WSTOPSIG(status), status >> 16
        request, deliver = kernel.CONT, 0
        try:
            if event == kernel.EVENT_SECCOMP:
                request = kernel.SYSCALL if self._enter(thread) else kernel.CONT
            elif number == SYSCALL_STOP:
                self._leave(thread)
            elif event == kernel.EVENT_STOP:
                request = kernel.LISTEN if number in GROUP_STOPS else kernel.CONT
            elif event == 0:
                deliver = number
            kernel.ptrace(request, thread, 0, deliver)
        except ProcessLookupError:
            # Killed while it was stopped; its end comes by waitpid.
            return

    def _enter(self, thread: int) -> bool:
        """Read a call before it is executed; return whether its return is recorded."""
        began_ns = time.monotonic_ns()
        number, *arguments = kernel.stop_of(thread).values
        event = self.reader.read(thread, self.machine.name[number], arguments)
        if event is None:
            return False
        self._begun[thread] = replace(event, began=self._next(), began_ns=began_ns)
        return True

    def _leave(self, thread: int) -> None:
        stop, event = kernel.stop_of(thread), self._begun.pop(thread, None)
        if event is None or not stop.at_exit:
            raise RuntimeError(f"thread {thread} stopped out of turn: {stop}, {event}")
        result = stop.values[0]
        taken = event.data[: max(0, result)]
        self._write(
            replace(
                event,
                data=taken,
                result=result,
                ended=self._next(),
                ended_ns=time.monotonic_ns(),
            )
        )

    def _next(self) -> int:
        self._stamp += 1
        return self._stamp

    def _write(self, event: Event | None) -> None:
        if event is not None:
            write_event(self.output, event)


def trace(record: Path, folder: Path, command: Sequence[str]) -> int:
    """Run `command`, record its changes to `folder` and its sends, and return its exit code."""
    machine = this_machine()
    if machine is None:
        return _refuse("this system's calls are not known to the tracer")
    gate, opener = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(opener)
        _become(command, machine, gate)
    os.close(gate)
    try:
        kernel.ptrace(kernel.SEIZE, child, 0, kernel.OPTIONS)
    except OSError as error:
        os.kill(child, signal.SIGKILL)
        return _refuse(str(error))
    for request in (signal.SIGTERM, signal.SIGINT):
        signal.signal(request, lambda number, _: os.kill(child, number))
    os.write(opener, b"!")
    os.close(opener)
    with record.open("wb") as output:
        reader = Reader(folder.resolve())
        code = Tracer(machine, reader, output).follow(child)
    return code if code >= 0 else 128 - code


def _become(command: Sequence[str], machine: Machine, gate: int) -> None:
    """In the child, wait for the tracer, install the filter and execute the command."""
    try:
        os.read(gate, 1)
        kernel.only_stop_at(machine)
        os.execvp(command[0], list(command))  # noqa: S606 - it becomes the command
    except OSError as error:
        os.write(sys.stderr.fileno(), f"{error}\n".encode())
        os._exit(REFUSED)


def _refuse(why: str) -> int:
    sys.stderr.write(f"{why}\n")
    return REFUSED
