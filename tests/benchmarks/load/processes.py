"""The processes of a load, and the protocol for communicating with them."""

import json
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol, Self

REPOSITORY = Path(__file__).resolve().parents[3]
ANSWERS_WITHIN_S = 300.0


class Plan(Protocol):
    """The plan that is passed to a process."""

    def as_json(self) -> str:
        """Return the plan as one line of JSON."""


@dataclass
class Companion:
    """A benchmark module that runs in a separate process."""

    process: "subprocess.Popen[str]"
    errors: Path

    @classmethod
    def start(cls, module: str, plan: Plan, errors: Path) -> Self:
        """Start `tests.benchmarks.MODULE` and pass the plan to it."""
        with errors.open("w") as told:
            process = subprocess.Popen(
                [sys.executable, "-m", f"tests.benchmarks.{module}"],
                cwd=REPOSITORY,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=told,
                text=True,
            )
        made = cls(process, errors)
        made._say(plan.as_json())
        return made

    def wait_for(self, word: str) -> None:
        """Wait for this line; raise RuntimeError with the output if another line arrives."""
        heard = self._hear()
        if heard != word:
            raise RuntimeError(f"expected {word!r}, heard {heard!r}; {self._last_words()}")

    def begin(self, begin_s: float) -> None:
        """Send the start time to the process."""
        self._say(repr(begin_s))

    def result(self) -> dict[str, Any]:
        """Wait for the end of the process and return its result."""
        text = self._hear()
        self.process.wait(ANSWERS_WITHIN_S)
        if self.process.returncode != 0 or not text:
            raise RuntimeError(f"exit code {self.process.returncode}; {self._last_words()}")
        told: dict[str, Any] = json.loads(text)
        return told

    @property
    def pid(self) -> int:
        """Return the process id."""
        return self.process.pid

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.end()

    def end(self) -> None:
        """Kill the process if it is still running."""
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()
        for pipe in (self.process.stdin, self.process.stdout):
            if pipe is not None:
                pipe.close()

    def _say(self, line: str) -> None:
        assert self.process.stdin is not None
        self.process.stdin.write(f"{line}\n")
        self.process.stdin.flush()

    def _hear(self) -> str:
        assert self.process.stdout is not None
        return self.process.stdout.readline().strip()

    def _last_words(self) -> str:
        return f"its errors:\n{self.errors.read_text(errors='replace')[-3000:]}"
