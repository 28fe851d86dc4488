"""A partner that is another process on this machine and speaks JSON lines.

We listen on 127.0.0.1 and nowhere else. The process is either started by us, with a token of its
own, or by the user before the scene begins; a process that another program of this machine has
started can only take the place of the latter.
"""

import os
import secrets
import socket
import subprocess
import sys
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from pydantic import BaseModel, ValidationError

from app.adapters.cosimulation.lines import Lines, LineTooLongError
from app.adapters.cosimulation.messages import (
    End,
    Hello,
    StateMessage,
    Step,
    Welcome,
    actor_message,
    line_of,
    road_message,
)
from app.science.cosimulation import (
    CosimulationError,
    PartnerLostError,
    Request,
    Road,
    SceneOverError,
    State,
)

TOKEN_VARIABLE = "REEMBODY_PARTNER_TOKEN"  # noqa: S105 - the name of a variable
_LOOPBACK = "127.0.0.1"
LOOK_S = 0.2
"""How often a scene that waits for a process looks whether it goes on waiting."""


@dataclass(frozen=True)
class ProcessPlan:
    """How a process takes part.

    Attributes:
        name: of the partner.
        step_s: its step.
        command: what is started, with {address}, {folder}, {python} and {reembody} replaced; empty
            if the user starts it.
        folder: of the scene's file.
        port: where we listen; 0 for any free one.
        connect_s: how long it may take to connect.
    """

    name: str
    step_s: float
    command: tuple[str, ...] = ()
    port: int = 0
    connect_s: float = 30.0
    folder: Path = Path()


class ProcessPartner:
    """One process, connected from `start` until `close`.

    Args:
        plan: how it takes part.
        road, seed: of the scene, which it is told.
        is_over: whether the scene has ended, so that nobody waits for the process any more.

    Raises:
        CosimulationError: the port is taken.
    """

    def __init__(
        self, plan: ProcessPlan, road: Road, seed: int, is_over: Callable[[], bool] = lambda: False
    ) -> None:
        self.name, self.step_s = plan.name, plan.step_s
        self._plan, self._road, self._seed, self._is_over = plan, road, seed, is_over
        try:
            self._listener = socket.create_server((_LOOPBACK, plan.port))
        except OSError as error:
            raise CosimulationError(
                f"{plan.name!r} cannot be waited for at {_LOOPBACK}:{plan.port}:"
                f" {os.strerror(error.errno or 0)}. Another program, or the scene of another"
                " session, may have this port: end it, or give this partner another port."
            ) from error
        self._process: subprocess.Popen[bytes] | None = None
        self._lines: Lines | None = None

    @property
    def address(self) -> str:
        """Where the process connects, HOST:PORT."""
        return f"{_LOOPBACK}:{self._listener.getsockname()[1]}"

    @property
    def is_started_by_us(self) -> bool:
        """Whether `start` starts the process; else it waits for one that the user starts."""
        return bool(self._plan.command)

    def start(self) -> tuple[State, ...]:
        """Start the process or wait for it, greet it, and return its actors at 0 s.

        Raises:
            PartnerLostError: it did not come, or has gone.
            SceneOverError: the scene ended meanwhile.
        """
        token = secrets.token_hex(16) if self._plan.command else ""
        if self._plan.command:
            self._launch(token)
        self._accept(token)
        self._send(
            Welcome(
                partner=self.name,
                step_s=self.step_s,
                seed=self._seed,
                road=road_message(self._road),
            )
        )
        until = time.monotonic() + self._plan.connect_s
        while time.monotonic() < until:
            self._require_scene()
            states = self.answer(LOOK_S)
            if states is not None:
                return states
        raise PartnerLostError(f"{self.name!r} did not say its actors at 0 s.")

    def begin(self, request: Request) -> None:
        """Ask the process for one step."""
        others = tuple(actor_message(state) for state in request.others)
        self._send(Step(from_s=request.from_s, to_s=request.to_s, others=others))

    def answer(self, timeout_s: float) -> tuple[State, ...] | None:
        """Return the process's answer, None if there is none in time."""
        line = self._receive(timeout_s)
        if line is None:
            return None
        try:
            return StateMessage.model_validate_json(line).states()
        except (ValidationError, CosimulationError) as error:
            raise self._misspoke(error) from None

    def close(self) -> None:
        """Say that the scene has ended, and end a process that we started."""
        if self._lines is not None:
            with suppress(OSError):  # it may have gone already
                self._lines.send(line_of(End()))
            self._lines.close()
        self._listener.close()
        if self._process is not None:
            _end(self._process)

    def _launch(self, token: str) -> None:
        command = _filled(self._plan, self.address)
        environment = {**os.environ, TOKEN_VARIABLE: token}
        try:
            # The command is a list from the scene file of the user who runs it; no shell.
            self._process = subprocess.Popen(command, env=environment, stdin=subprocess.DEVNULL)  # noqa: S603
        except OSError as error:
            raise PartnerLostError(
                f"{self.name!r} cannot be started: {command[0]}: {error.strerror}."
            ) from None

    def _accept(self, token: str) -> None:
        until = time.monotonic() + self._plan.connect_s
        while time.monotonic() < until:
            self._require_scene()
            self._listener.settimeout(LOOK_S)
            try:
                connection, _ = self._listener.accept()
            except TimeoutError:
                if self._process is not None and self._process.poll() is not None:
                    raise PartnerLostError(
                        f"{self.name!r} ended with exit code {self._process.returncode} before it"
                        " connected."
                    ) from None
                continue
            lines = Lines(connection)
            if self._is_greeted(lines, token):
                self._lines = lines
                return
            lines.close()
        raise PartnerLostError(
            f"{self.name!r} did not connect to {self.address} within {self._plan.connect_s:g} s."
        )

    def _require_scene(self) -> None:
        if self._is_over():
            raise SceneOverError

    def _is_greeted(self, lines: Lines, token: str) -> bool:
        """Whether a connection is that of the expected process; any other is closed."""
        try:
            hello = Hello.model_validate_json(lines.receive(2.0) or b"")
        except (ValidationError, LineTooLongError, OSError):
            return False
        return hello.partner == self.name and secrets.compare_digest(
            hello.token.encode(), token.encode()
        )

    def _send(self, message: BaseModel) -> None:
        assert self._lines is not None  # noqa: S101 - `start` comes first
        try:
            self._lines.send(line_of(message))
        except OSError as error:
            raise self._gone(error) from None

    def _receive(self, timeout_s: float) -> bytes | None:
        assert self._lines is not None  # noqa: S101 - `start` comes first
        try:
            line = self._lines.receive(timeout_s)
        except LineTooLongError as error:
            raise PartnerLostError(f"{self.name!r}: {error}.") from None
        except OSError as error:
            raise self._gone(error) from None
        if line == b"":
            raise self._gone(None)
        return line

    def _gone(self, error: OSError | None) -> PartnerLostError:
        reason = "" if error is None else f": {error.strerror or error}"
        return PartnerLostError(f"{self.name!r} has closed its connection{reason}.")

    def _misspoke(self, error: ValidationError | CosimulationError) -> PartnerLostError:
        if isinstance(error, ValidationError):
            first = error.errors(include_url=False, include_context=False, include_input=False)[0]
            where = ".".join(str(part) for part in first["loc"])
            said = f"{where}: {first['msg']}" if where else first["msg"]
        else:
            said = str(error)
        return PartnerLostError(f"{self.name!r} said something that is not valid: {said}")


def _filled(plan: ProcessPlan, address: str) -> list[str]:
    """Return a command with its placeholders replaced; {reembody} becomes several words."""
    words: list[str] = []
    for word in plan.command:
        if word == "{reembody}":
            words += [sys.executable, "-m", "app.cli"]
        elif word == "{python}":
            words.append(sys.executable)
        else:
            filled = word.replace("{address}", address)
            words.append(filled.replace("{folder}", str(plan.folder)))
    return words


def _end(process: subprocess.Popen[bytes]) -> None:
    try:
        process.wait(2.0)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
