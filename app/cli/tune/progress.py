"""What a tuning says about itself while it goes on, on standard error."""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from app.science.avatar.tuning import TuningProgress

_PHASES = {"relay": "relay experiment", "steps": "step on the whole body"}


@contextmanager
def tell_progress() -> Iterator[Callable[[TuningProgress], None]]:
    """One line that is written over, on a terminal; elsewhere a line a phase."""
    live = sys.stderr.isatty()
    yield _tell_live if live else _tell_phases
    if live:
        sys.stderr.write("\r\033[K")
        sys.stderr.flush()


def _tell_live(at: TuningProgress) -> None:
    sys.stderr.write(f"\r\033[K{_line(at)}  {at.axis}")
    sys.stderr.flush()


def _tell_phases(at: TuningProgress) -> None:
    if at.done == at.total:
        sys.stderr.write(f"{_line(at)}\n")


def _line(at: TuningProgress) -> str:
    return f"attempt {at.attempt}, {_PHASES[at.phase]}: {at.done} of {at.total} axes"
