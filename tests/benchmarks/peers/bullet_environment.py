"""Install PyBullet in a separate environment, since no part of the product needs it.

It is installed on first use into `.cache/` of the checkout, with the interpreter that runs the
benchmarks and from the index configured for uv. There are wheels for CPython 3.11 and older; for a
newer one uv builds the source, which takes a compiler and many minutes.
"""

import hashlib
import os
import shutil
import subprocess
import sys
from pathlib import Path

from tests.support.shared_run import locked

REPOSITORY = Path(__file__).resolve().parents[3]
REQUIREMENTS = ("pybullet==3.2.7", "numpy>=2,<3")
"""Its wheels need NumPy 2 without declaring it."""
_LONGEST_S = 1800


class NoPyBullet(RuntimeError):
    """Raised if PyBullet could not be installed; the message says why."""


def pybullet_python() -> Path:
    """Return the interpreter that has PyBullet, creating its environment if it is missing.

    Raises:
        NoPyBullet: there is no uv, or the installation failed.
    """
    cache = REPOSITORY / ".cache" / "peers"
    key = hashlib.sha256(" ".join((sys.version, *REQUIREMENTS)).encode()).hexdigest()[:16]
    folder = cache / f"pybullet-{key}"
    python = folder / "bin" / "python"
    with locked(cache / "install.lock"):
        if not (folder / "done").exists():
            print(f"  installing {REQUIREMENTS[0]} into {folder}", file=sys.stderr)
            shutil.rmtree(folder, ignore_errors=True)
            uv = _uv()
            _call([uv, "venv", "--quiet", "--no-project", "--python", sys.executable, folder])
            _call([uv, "pip", "install", "--quiet", "--python", python, *REQUIREMENTS])
            (folder / "done").touch()
    return python


def _uv() -> str:
    found = shutil.which("uv") or shutil.which(REPOSITORY / ".uv" / "bin" / "uv")
    if found is None:
        raise NoPyBullet("uv was not found: ./run fetches it where it is missing")
    return found


def _call(command: list[str | Path]) -> None:
    # Nothing must be installed into the benchmark's own environment.
    inherited = {name: value for name, value in os.environ.items() if name != "VIRTUAL_ENV"}
    try:
        done = subprocess.run(
            command, capture_output=True, text=True, check=False, timeout=_LONGEST_S, env=inherited
        )
    except (OSError, subprocess.TimeoutExpired) as error:
        raise NoPyBullet(f"{command[1]} did not end well: {error}") from error
    if done.returncode != 0:
        raise NoPyBullet(f"{' '.join(map(str, command[:3]))} failed: {done.stderr[-2000:]}")
