"""Install peers on first use, each into a separate folder below `.cache/peers`.

No part of the product needs them. They come from the indexes configured for uv and npm.
"""

import hashlib
import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Mapping
from pathlib import Path

from tests.support.node import NODE, NPM, node_environment
from tests.support.shared_run import locked

REPOSITORY = Path(__file__).resolve().parents[3]
CACHE = REPOSITORY / ".cache" / "peers"
_LONGEST_S = 600


class NoPeer(RuntimeError):
    """Raised if a peer could not be installed; the message says why."""


def python_peer(name: str, *requirements: str) -> Path:
    """Return the folder of programs of an environment in which `requirements` are installed.

    Raises:
        NoPeer: there is no uv, or the installation failed.
    """

    def install(folder: Path) -> None:
        uv = _uv()
        python = folder / "bin" / "python"
        _call([uv, "venv", "--quiet", "--no-project", "--python", sys.executable, folder])
        _call([uv, "pip", "install", "--quiet", "--python", python, *requirements])

    return _installed(name, (sys.version, *requirements), install) / "bin"


def npm_peer(name: str, *packages: str) -> Path:
    """Return a `node_modules` with `packages` (`name@version`), installed without their scripts.

    Raises:
        NoPeer: the installation failed.
    """

    def install(folder: Path) -> None:
        folder.mkdir(parents=True)
        (folder / "package.json").write_text(json.dumps({"private": True}))
        _call(
            [NODE, NPM, "install", "--ignore-scripts", "--no-audit", "--no-fund", *packages],
            cwd=folder,
            environment=node_environment(),
        )

    return _installed(name, packages, install) / "node_modules"


def _installed(name: str, of: tuple[str, ...], install: Callable[[Path], None]) -> Path:
    key = hashlib.sha256(" ".join(of).encode()).hexdigest()[:16]
    folder = CACHE / f"{name}-{key}"
    with locked(CACHE / "install.lock"):
        if not (folder / "done").exists():
            print(f"  installing {name} into {folder}", file=sys.stderr)
            shutil.rmtree(folder, ignore_errors=True)
            install(folder)
            (folder / "done").touch()
    return folder


def _uv() -> Path:
    found = shutil.which("uv") or shutil.which(REPOSITORY / ".uv" / "bin" / "uv")
    if found is None:
        raise NoPeer("uv was not found: ./run fetches it where it is missing")
    return Path(found)


def _call(
    command: list[str | Path],
    cwd: Path | None = None,
    environment: Mapping[str, str] | None = None,
) -> None:
    # Nothing must be installed into the benchmark's own environment.
    given = dict(os.environ if environment is None else environment)
    given.pop("VIRTUAL_ENV", None)
    try:
        done = subprocess.run(
            command,
            capture_output=True,
            text=True,
            check=False,
            timeout=_LONGEST_S,
            cwd=cwd,
            env=given,
        )
    except (OSError, subprocess.TimeoutExpired) as error:
        raise NoPeer(f"{command[1]} did not end well: {error}") from error
    if done.returncode != 0:
        raise NoPeer(f"{' '.join(map(str, command[:3]))} failed: {done.stderr[-2000:]}")
