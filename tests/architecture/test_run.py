"""Tests that `./run` sets up only the changed parts, from any folder, and logs to stderr.

A substitute for uv records its calls, so these tests need no network and little time.
"""

import os
import shlex
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[2]
INPUTS = (
    "run",
    "set_up.py",
    "build_pages.py",
    "hatch_build.py",
    "pyproject.toml",
    "requirements.lock",
    "requirements-build.lock",
    "requirements-dev.lock",
)
UV = """
import pathlib, sys, time
here = pathlib.Path({folder!r})
with (here / "calls.log").open("a") as log:
    print(*sys.argv[1:3], pathlib.Path(sys.argv[-1]).name, file=log)
print("noise of uv")
if (here / "broken").exists():
    sys.exit("uv: no network")
if (here / "endless").exists() and sys.argv[-1].endswith("requirements.lock"):
    time.sleep(1000)
if sys.argv[1] == "venv":
    programs = pathlib.Path(sys.argv[-1]) / "bin"
    programs.mkdir(parents=True)
    for name in ("python", "reembody"):
        program = programs / name
        program.write_text(pathlib.Path(here / "program").read_text().replace("NAME", name))
        program.chmod(0o755)
elif "--target" in sys.argv:
    pathlib.Path(sys.argv[sys.argv.index("--target") + 1]).mkdir(parents=True)
"""
# The installed program: it sets up for real, builds pages that are only a stamp, and otherwise
# prints its name.
PROGRAM = """#!/bin/sh
case "$*" in
    *set_up.py*) exec {python} "$@" ;;
    *build_pages.py*)
        echo "build pages" >>{folder}/calls.log
        if [ -e {folder}/unhappy ]; then echo "npm: the page is unhappy" >&2; exit 1; fi
        cd "$(dirname "$1")" && mkdir -p app/static
        exec {python} -c 'import build_pages as b, pathlib
pathlib.Path("app/static", b.STAMP).write_text(b.sources_hash(pathlib.Path("frontend")))' ;;
    "-c import"*) ;;
    *) printf "%s|" NAME "$PWD" "$@" ;;
esac
"""


@dataclass(frozen=True)
class Checkout:
    """A folder with `run` and the files it depends on, and a substitute for uv."""

    folder: Path
    tools: Path

    def run(self, *arguments: str, cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
        """Call `./run` in the checkout."""
        path = f"{self.tools}{os.pathsep}{os.defpath}"
        return subprocess.run(
            [self.folder / "run", *arguments],
            cwd=cwd or self.folder,
            env={"PATH": path},
            capture_output=True,
            text=True,
            check=False,
        )

    def calls(self) -> list[str]:
        """Return the steps taken since the last call, sorted, since two sides run in parallel."""
        log = self.tools / "calls.log"
        calls = log.read_text().splitlines() if log.exists() else []
        log.unlink(missing_ok=True)
        return sorted(calls)


def append(path: Path, line: str) -> None:
    """Add a line to a file, which may be new."""
    with path.open("a") as file:
        file.write(f"\n{line}\n")


@pytest.fixture
def checkout(tmp_path: Path) -> Checkout:
    """Provide a fresh checkout below a folder with spaces and quotes in its name."""
    folder = tmp_path / "it's a folder"
    tools = tmp_path / "tools"
    folder.mkdir()
    tools.mkdir()
    for name in INPUTS:
        shutil.copy(REPOSITORY / name, folder / name)
    (folder / "frontend").mkdir()
    (folder / "frontend" / "package.json").write_text("{}")
    script = tools / "uv.py"
    script.write_text(UV.format(folder=str(tools)))
    python = shlex.quote(sys.executable)
    (tools / "program").write_text(PROGRAM.format(python=python, folder=shlex.quote(str(tools))))
    uv = tools / "uv"
    # Not a Python script itself: this Python's own path may contain spaces.
    uv.write_text(
        f'#!/bin/sh\nexec {shlex.quote(sys.executable)} {shlex.quote(str(script))} "$@"\n'
    )
    uv.chmod(0o755)
    return Checkout(folder, tools)


def test_the_second_call_sets_nothing_up(checkout: Checkout) -> None:
    """A second call of `./run` sets nothing up and prints nothing about it."""
    first = checkout.run("score")
    assert first.returncode == 0, first.stderr
    assert checkout.calls() == [
        "build pages",
        f"pip install {checkout.folder.name}",
        "pip install requirements-build.lock",
        "pip install requirements.lock",
        "venv --quiet .venv",
    ]
    again = checkout.run("score")
    assert checkout.calls() == []
    assert again.stderr == ""
    assert again.stdout == first.stdout


def test_arguments_and_paths_pass_through_unchanged(checkout: Checkout, tmp_path: Path) -> None:
    """Arguments pass through `./run` unchanged, and relative paths stay relative to the caller."""
    result = checkout.run("score", "two words", "*", cwd=tmp_path)
    assert result.stdout == f"reembody|{tmp_path}|score|two words|*|"
    assert "installing the Python packages of requirements.lock" in result.stderr


@pytest.mark.parametrize("arguments", [[], ["serve"]])
def test_serving_is_the_default(checkout: Checkout, arguments: list[str]) -> None:
    """`./run` without arguments is the same as `./run serve`."""
    assert checkout.run(*arguments).stdout == f"reembody|{checkout.folder}|serve|"


def test_options_alone_belong_to_serving(checkout: Checkout) -> None:
    """`./run --port 9000` means `./run serve --port 9000`; `--help` and `--version` do not."""
    assert checkout.run("--port", "9000").stdout.endswith("|serve|--port|9000|")
    helped = checkout.run("--help").stdout
    assert "|--help|" in helped
    assert all(f"./run {name} " in helped for name in ("check", "test", "bench"))
    assert checkout.run("--version").stdout.endswith("|--version|")


def test_tests_get_the_development_requirements(checkout: Checkout) -> None:
    """The development requirements suffice for running, so `./run` then installs nothing."""
    assert checkout.run("test", "-k", "x").stdout.endswith("|-m|tests.support.stages|-k|x|")
    assert checkout.run("check", "app").stdout.endswith("|-m|tests.support.checking|app|")
    assert "pip install requirements-dev.lock" in checkout.calls()
    checkout.run("score")
    assert checkout.calls() == []


@pytest.mark.parametrize(
    ("changed", "call"),
    [
        ("requirements.lock", "pip install requirements.lock"),
        ("pyproject.toml", "pip install it's a folder"),
        ("hatch_build.py", "pip install it's a folder"),
        ("frontend/src/page.ts", "build pages"),
    ],
)
def test_a_changed_input_repeats_its_own_step(checkout: Checkout, changed: str, call: str) -> None:
    """A changed input repeats only the set-up step that depends on it."""
    checkout.run("score")
    checkout.calls()
    path = checkout.folder / changed
    path.parent.mkdir(parents=True, exist_ok=True)
    append(path, "# changed")
    checkout.run("score")
    assert checkout.calls() == [call]


def test_a_failed_build_ends_the_installation(checkout: Checkout) -> None:
    """If building the pages fails, the installation of packages is stopped; both are repeated."""
    (checkout.tools / "unhappy").touch()
    (checkout.tools / "endless").touch()
    failed = checkout.run("score")
    assert failed.returncode != 0
    assert failed.stdout == ""
    assert "npm: the page is unhappy" in failed.stderr
    (checkout.tools / "unhappy").unlink()
    (checkout.tools / "endless").unlink()
    checkout.calls()
    assert checkout.run("score").returncode == 0
    assert {"build pages", "pip install requirements.lock"} <= set(checkout.calls())


def test_an_interrupted_step_is_repeated(checkout: Checkout) -> None:
    """A failed set-up step ends `./run` with uv's output and is repeated by the next call."""
    checkout.run("score")
    append(checkout.folder / "requirements.lock", "# changed")
    (checkout.tools / "broken").touch()
    failed = checkout.run("score")
    assert failed.returncode != 0
    assert failed.stdout == ""
    assert "uv: no network" in failed.stderr
    (checkout.tools / "broken").unlink()
    checkout.calls()
    assert checkout.run("score").returncode == 0
    assert checkout.calls() == ["pip install requirements.lock"]


def test_a_moved_folder_is_installed_again(checkout: Checkout, tmp_path: Path) -> None:
    """After its folder was moved, the project is installed again from the new path."""
    checkout.run("score")
    checkout.calls()
    moved = Checkout(checkout.folder.rename(tmp_path / "elsewhere"), checkout.tools)
    assert moved.run("score").returncode == 0
    assert moved.calls() == ["pip install elsewhere"]


def test_without_uv_and_pip_the_remedy_is_named(checkout: Checkout) -> None:
    """On a machine without uv and pip, the message says what to install."""
    python = checkout.tools / "python3"
    python.write_text("#!/bin/sh\nexit 1\n")
    python.chmod(0o755)
    (checkout.tools / "uv").unlink()
    result = checkout.run("score")
    assert result.returncode == 1
    assert "install one of them" in result.stderr
