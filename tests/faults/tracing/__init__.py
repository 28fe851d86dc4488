"""Record a process's disk calls and socket sends in the order in which they happen.

    python -m tests.faults.tracing RECORD FOLDER -- COMMAND ...

runs COMMAND under the kernel's tracing interface (ptrace) and writes a record of every change to
files in FOLDER and of every byte sent on a socket, of all its threads. It needs only Python and a
Linux kernel (5.3 or newer, x86-64 or ARM64) that allows a process to trace its own child.
"""
