"""Fork the product's worker processes from one process that has already imported their modules.

The product starts each worker with `spawn`: a new Python that imports for one to three seconds
before its first task. In the tests `spawn` is multiprocessing's own fork server instead, a process
with a single thread that forks a worker on request over a socket:

    test process, or a server of its nursery --(socket)--> fork server --(fork)--> worker

Tasks and results are pickled as with `spawn`, but a worker does not inherit the environment, the
limits or the output of the process that requested it. `spawn` itself is covered by the tests that
start a Python of their own (tests/platform/test_workers.py, tests/lan, tests/architecture).
"""

import errno
import multiprocessing
import os
import select
import socket
from collections.abc import Callable
from functools import partial
from importlib import import_module
from multiprocessing import forkserver, reduction
from typing import Any

HEAVY = ("mujoco", "numba", "pandas", "plotly.graph_objects", "scipy.ndimage", "scipy.stats")
"""Modules that workers import and servers do not."""


def listener() -> socket.socket:
    """Return the socket of a fork server that starts later; earlier connections wait for it."""
    listener = socket.socket(socket.AF_UNIX)
    listener.bind("")  # Linux names it; no file is left behind
    listener.listen(100)
    return listener


def use_fork_server(address: Callable[[], bytes]) -> None:
    """Make `spawn` use the fork server at `address()`, also in forks of this process."""
    server = vars(forkserver._forkserver)
    # The descriptor would keep a fork server alive; this one ends with the nursery.
    server["_forkserver_alive_fd"] = os.open(os.devnull, os.O_RDONLY)
    server["ensure_running"] = lambda: server.update(_forkserver_address=address())
    vars(multiprocessing).update(get_context=partial(_context, multiprocessing.get_context))


def _context(original: Any, method: str | None = None) -> Any:
    return original("forkserver" if method == "spawn" else method)


def leave_fork_server(listener: socket.socket, *foreign: int) -> None:
    """Fork a fork server, which ends when this process has ended.

    Args:
        listener: the socket of its requests.
        foreign: descriptors of this process that the child must not keep open.
    """
    ended, held = os.pipe()
    if os.fork() == 0:
        for descriptor in (*foreign, held):
            os.close(descriptor)
        readable, _, _ = select.select([listener.fileno(), ended], [], [])
        if listener.fileno() in readable:
            for name in HEAVY:
                import_module(name)
        vars(reduction).update(recvfds=partial(_descriptors, reduction.recvfds))
        forkserver.main(listener.fileno(), ended, [])
    os.close(ended)
    listener.close()


def _descriptors(receive: Any, connection: socket.socket, count: int) -> Any:
    """Receive a request; one whose sender was killed meanwhile is passed over.

    Otherwise it would end the fork server, and no later worker of the run could start.
    """
    try:
        return receive(connection, count)
    except (EOFError, OSError, RuntimeError) as error:
        raise ConnectionAbortedError(errno.ECONNABORTED, "the request was not sent") from error
