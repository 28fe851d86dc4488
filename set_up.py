"""Install what is missing or outdated: the Python packages and the pages, in parallel.

    python set_up.py run|dev --check      exit code 0 if there is nothing to do
    python set_up.py run|dev --uv PATH    do it

The script `run` calls it with the Python of `.venv`, before anything is installed there, so it uses
only the standard library. Two tasks run in parallel:

    Python: the packages of a lock file, then the project, then one import of the server
    pages:  npm's packages, then the build

Both need the build tools (hatchling and Node), which are fetched first, into a folder of their own:
`.venv` contains only what the server runs with. All output goes to standard error.
"""

import argparse
import hashlib
import os
import shutil
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Sequence
from concurrent.futures import FIRST_EXCEPTION, Future, ThreadPoolExecutor, wait
from dataclasses import dataclass, field
from pathlib import Path

from build_pages import are_current, say

ROOT = Path(__file__).resolve().parent
VENV = ROOT / ".venv"
PYTHON = VENV / "bin" / "python"
TOOLS = ROOT / ".cache" / "build"
FRONTEND = ROOT / "frontend"
# What a server imports before it listens; importing it compiles it and has no other effect.
STARTS = "import app.cli.serve.run, uvicorn.protocols.http.httptools_impl"
PROGRESS_EVERY_S = 20.0
TERMINATED = 128 + signal.SIGTERM


class StepFailed(Exception):
    """A command failed and has reported why, or was ended because another failed."""


@dataclass(frozen=True)
class Stamp:
    """A file that marks a step as done and contains a key of the step's inputs.

    It is deleted before the step and written after it, so an interrupted step never counts as done.
    """

    file: Path

    def says(self, key: str) -> bool:
        """Return whether the step is done for this key."""
        return self.file.is_file() and self.file.read_text().strip() == key

    def begin(self) -> None:
        """Mark the step as not done."""
        self.file.unlink(missing_ok=True)

    def finish(self, what: str) -> None:
        """Mark the step as done for this key."""
        self.file.write_text(f"{what}\n")


@dataclass
class Commands:
    """The running commands; `end` ends them all, with every process that they started."""

    _running: "dict[subprocess.Popen[bytes], str]" = field(default_factory=dict)
    _lock: threading.Lock = field(default_factory=threading.Lock)
    _over: bool = False

    def run(self, doing: str, *command: str | Path, **environment: str | None) -> None:
        """Announce a command and run it; an `environment` value of None unsets the variable."""
        given = {**os.environ, **environment}
        with self._lock:
            if self._over:
                raise StepFailed
            say(doing)
            process = subprocess.Popen(
                command,
                cwd=ROOT,
                env={name: value for name, value in given.items() if value is not None},
                stdin=subprocess.DEVNULL,
                stdout=sys.stderr,
                process_group=0,
            )
            self._running[process] = doing
        code = process.wait()
        with self._lock:
            del self._running[process]
        if code != 0:
            raise StepFailed

    def underway(self) -> str:
        """Describe the commands that are running now."""
        with self._lock:
            return ", ".join(self._running.values())

    def end(self) -> None:
        """End the running commands, and start no more."""
        with self._lock:
            self._over = True
            for process in self._running:
                os.killpg(process.pid, signal.SIGTERM)


@dataclass(frozen=True)
class SetUp:
    """The set-up for one mode: "run" for running Reembody, "dev" for developing it, too."""

    mode: str
    uv: Path
    commands: Commands = field(default_factory=Commands)

    @property
    def lock_file(self) -> Path:
        """The lock file of the Python packages that the mode needs."""
        return ROOT / ("requirements.lock" if self.mode == "run" else "requirements-dev.lock")

    def is_ready(self) -> bool:
        """Return whether there is nothing to do."""
        return self.has_packages() and self.has_project() and has_pages()

    def has_packages(self) -> bool:
        """Return whether the Python packages are installed.

        The packages of "dev" include those of "run".
        """
        accepted = ("run", "dev") if self.mode == "run" else ("dev",)
        return any(PACKAGES.says(packages_key(mode)) for mode in accepted)

    def has_project(self) -> bool:
        """Return whether the project is installed from this folder, with its current metadata."""
        return PROJECT.says(project_key())

    def do(self) -> None:
        """Set up what is missing; raise StepFailed after the reason was reported."""
        began_s = time.monotonic()
        with ThreadPoolExecutor() as pool:
            tools = pool.submit(self.get_tools)
            sides = {
                pool.submit(self.install_python, tools),
                pool.submit(self.build_pages, tools),
            }
            try:
                while sides:
                    done, sides = wait(sides, PROGRESS_EVERY_S, FIRST_EXCEPTION)
                    for side in done:
                        side.result()
                    if sides and (doing := self.commands.underway()):
                        say(f"still {doing} ({time.monotonic() - began_s:.0f} s)")
            except BaseException:
                self.commands.end()
                raise

    def get_tools(self) -> None:
        """Fetch hatchling and Node, unless they are installed or not needed."""
        stamp, key = Stamp(TOOLS / ".done"), hash_of("requirements-build.lock")
        if (self.has_project() and has_pages()) or stamp.says(key):
            return
        shutil.rmtree(TOOLS, ignore_errors=True)
        self.pip_install(
            "fetching Node and the build's tools",
            *("--require-hashes", "--no-build", "--target", TOOLS),
            *("--requirement", ROOT / "requirements-build.lock"),
        )
        stamp.finish(key)

    def install_python(self, tools: "Future[None]") -> None:
        """Install the Python packages and the project."""
        if not self.has_packages():
            PACKAGES.begin()
            self.pip_install(
                f"installing the Python packages of {self.lock_file.name}",
                *("--require-hashes", "--no-build"),
                # Tests run in many processes, not all of which may write compiled files.
                *(["--compile-bytecode"] if self.mode == "dev" else []),
                *("--requirement", self.lock_file),
            )
            PACKAGES.finish(packages_key(self.mode))
        if not self.has_project():
            tools.result()
            PROJECT.begin()
            self.pip_install(
                "installing the project",
                *("--no-deps", "--no-build-isolation", "--reinstall", "--editable", ROOT),
                PYTHONPATH=str(TOOLS),
                REEMBODY_SKIP_FRONTEND="1",
            )
            self.compile()
            PROJECT.finish(project_key())

    def compile(self) -> None:
        """Compile the modules that the server imports at start, or all of them for development."""
        everything = ("-m", "compileall", "-q", "app", "migrations")
        self.commands.run(
            "compiling the project",
            *(PYTHON, *(("-c", STARTS) if self.mode == "run" else everything)),
            PYTHONDONTWRITEBYTECODE=None,
        )

    def build_pages(self, tools: "Future[None]") -> None:
        """Install npm's packages and build the pages."""
        if has_pages():
            return
        tools.result()
        everything = ["--every-package"] if self.mode == "dev" else []
        self.commands.run(
            "making the pages",
            *(PYTHON, ROOT / "build_pages.py", *everything),
            PYTHONPATH=str(TOOLS),
        )

    def pip_install(self, doing: str, *what: str | Path, **environment: str) -> None:
        """Run `uv pip install` into `.venv`, or into the target that `what` names."""
        install: Sequence[str | Path] = (self.uv, "pip", "install", "--quiet", "--python", PYTHON)
        self.commands.run(doing, *install, *what, **environment)


PACKAGES, PROJECT = Stamp(VENV / ".done-packages"), Stamp(VENV / ".done-project")


def hash_of(*names: str) -> str:
    """Return a hash of the contents of these files."""
    digests = [hashlib.sha256((ROOT / name).read_bytes()).hexdigest() for name in names]
    return hashlib.sha256(" ".join(digests).encode()).hexdigest()


def packages_key(mode: str) -> str:
    """Return the key of a mode's Python packages: the hash of its lock files."""
    more = ["requirements-dev.lock"] if mode == "dev" else []
    return f"{mode} {hash_of('requirements.lock', *more)}"


def project_key() -> str:
    """Return the key of the project's installation, which depends on this very folder."""
    return f"{hash_of('pyproject.toml', 'hatch_build.py')} {ROOT}"


def has_pages() -> bool:
    """Return whether the pages are current, or not needed."""
    needed = (FRONTEND / "package.json").is_file() and not os.environ.get("REEMBODY_SKIP_FRONTEND")
    return not needed or are_current(FRONTEND, ROOT / "app" / "static")


def main() -> int:
    """Check or set up; return 1 if that failed."""
    parser = argparse.ArgumentParser()
    parser.add_argument("mode", choices=["run", "dev"])
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--uv", type=Path, default=Path("uv"))
    options = parser.parse_args()
    setup = SetUp(options.mode, options.uv)
    if options.check:
        return 0 if setup.is_ready() else 1
    for request in (signal.SIGTERM, signal.SIGHUP):
        signal.signal(request, lambda *_: sys.exit(TERMINATED))
    try:
        setup.do()
    except StepFailed:
        say("the set-up did not succeed, see above; ./run goes on from here when called again")
        return 1
    except KeyboardInterrupt:
        return 130
    return 0


if __name__ == "__main__":
    sys.exit(main())
