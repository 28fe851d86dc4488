"""Tests that every command reports a missing file in a sentence before it does any work."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import get_args, get_type_hints

import pytest
import typer

from app.cli import progress
from app.cli.commands import app
from app.cli.errors import UNUSABLE
from app.errors import file_problem
from tests.cli.invoked import Invoked

MISSING = "nowhere.file"
TABLE = ("--subject", "id", "--within", "limb", "--measure", "score")
READ: dict[str, tuple[str, ...]] = {
    "score answers": (MISSING, "--instrument", "karas2020"),
    "analyse table": (MISSING, *TABLE),
    "retarget clip": (MISSING, "--to", "165cm"),
    "retarget skeleton": ("clip.amc", "--to", "165cm", "--skeleton", MISSING),
    "retarget joint_map": ("clip.bvh", "--to", "165cm", "--joint-map", MISSING),
    "retarget to": ("clip.bvh", "--to", MISSING),
    "tune capture": ("--evaluate", "--capture", MISSING),
    "walk fit walks": (MISSING, "--out", "model.npz"),
    "walk fit people": ("walks.csv", "--out", "model.npz", "--people", MISSING),
    "walk fit scene": ("walks.csv", "--out", "model.npz", "--scene", MISSING),
    "walk sample model": (MISSING, "--length", "3"),
    "walk evaluate model": (MISSING, "walks.csv"),
    "walk evaluate walks": ("model.npz", MISSING),
    "walk evaluate people": ("model.npz", "walks.csv", "--people", MISSING),
    "reach fit recordings": (MISSING, "--out", "reaching.npz"),
    "reach fit people": ("hands.csv", "--out", "reaching.npz", "--people", MISSING),
    "reach evaluate model": (MISSING,),
    "reach sample model": (MISSING, "--distance", "0.3"),
    "avatar save file": (MISSING, "mine"),
    "avatar edit operations": ("standard", "--operations", MISSING),
    "instrument answers": (MISSING,),
    "rehearse capture": ("--capture", MISSING),
    "pilot power assumptions": ("reembodiment-latency", "--assumptions", MISSING),
    "pilot merge records": (MISSING,),
    "pilot merge assumptions": ("cohort.jsonl", "--assumptions", MISSING),
    "pilot cohort assumptions": ("reembodiment-latency", "--assumptions", MISSING),
    "pilot cohort reaching": ("reembodiment-latency", "--reaching", MISSING),
    "pilot check scene": ("reembodiment-latency", "--scene", MISSING),
    "tracking align headset": (MISSING, MISSING),
    "tracking align tracker": ("head.csv", MISSING),
    "tracking align move": ("head.csv", "head.csv", "--move", MISSING, "--out", "moved.csv"),
    "crossing vehicle fmu": ("--connect", "127.0.0.1:1", "--fmu", MISSING),
    "restore file": (MISSING,),
    "restore erasures": ("whole.reembody", "--erasures", MISSING),
    "serve certificate": ("--lan", "--certificate", MISSING, "--key", "key.pem"),
    "serve key": ("--lan", "--certificate", "key.pem", "--key", MISSING),
}
"""By `command parameter`: arguments of the command with one missing file."""
SAME: dict[str, tuple[str, tuple[str, ...]]] = {
    "walk fit walks": ("walks.csv", ("walks.csv",)),
    "walk fit people": ("head.csv", ("walks.csv", "--people", "head.csv")),
    "walk fit scene": ("head.csv", ("walks.csv", "--scene", "head.csv")),
    "reach fit recordings": ("head.csv", ("head.csv",)),
    "reach fit people": ("walks.csv", ("head.csv", "--people", "walks.csv")),
    "retarget to": ("clip.bvh", ("other.bvh", "--to", "clip.bvh")),
    "tracking align headset": ("head.csv", ("head.csv", "walks.csv", "--move", "walks.csv")),
    "tracking align tracker": ("walks.csv", ("head.csv", "walks.csv", "--move", "head.csv")),
    "tracking align move": ("walks.csv", ("head.csv", "head.csv", "--move", "walks.csv")),
    "tune capture": ("clip.bvh", ("--capture", "clip.bvh")),
    "instrument answers": ("walks.csv", ("walks.csv",)),
    "avatar edit operations": ("walks.csv", ("standard", "--operations", "walks.csv")),
    "crossing run scene": ("walks.csv", ("walks.csv",)),
}
"""By `command parameter`: the file that is both read and written, and the arguments."""
ALIKE = {
    # These are read by the same code as those above, but only after files that must be valid.
    "walk evaluate model",
    "walk evaluate walks",
    "walk evaluate people",
    "restore erasures",
    "pilot merge assumptions",
}
WRITTEN = {
    "export to",
    "backup file",
    "retarget out",
    "figure out",
    "instrument out",
    "tune out",
    "avatar edit out",
    "avatar convert out",
    "avatar load out",
    "walk fit out",
    "reach fit out",
    "rehearse data",
    "pilot power out",
    "pilot cohort out",
    "crossing run out",
    "tracking align out",
}
"""Files and folders that a command creates."""


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Change to a folder with its own data and files, in which the command is run."""
    monkeypatch.chdir(tmp_path)
    # A slow machine says what it is doing; only the refusal is tested here.
    monkeypatch.setattr(progress, "FIRST_UPDATE_S", 600.0)
    monkeypatch.setenv("REEMBODY_DATA_DIR", str(tmp_path / "data"))
    (tmp_path / "key.pem").write_text("no key")
    (tmp_path / "clip.bvh").write_text(BVH)
    poses = "".join(f"{at},0,1.7,0,1,0,0,0\n" for at in range(9))
    (tmp_path / "head.csv").write_text(f"time_s,x_m,y_m,z_m,qw,qx,qy,qz\n{poses}")
    (tmp_path / "walks.csv").write_text("time_s,x_m,y_m,subject\n0,0,0,a\n1,1,0,a\n2,2,0,a\n")
    return tmp_path


BVH = """HIERARCHY
ROOT Hips
{
OFFSET 0 0 0
CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
End Site
{
OFFSET 0 10 0
}
}
MOTION
Frames: 1
Frame Time: 0.01
0 90 0 0 0 0
"""


@pytest.mark.parametrize("what", sorted(READ.keys() - ALIKE))
def test_a_missing_file_is_reported_in_a_sentence(what: str, folder: Path) -> None:
    """A missing file is reported in one sentence with its folder and without an error number."""
    command, arguments = what.split()[:-1], READ[what]
    output = Invoked(command[0]).refusal(*command[1:], *arguments)
    assert f"there is no file {MISSING} in {folder}" in output
    assert "Errno" not in output
    assert ".." not in output
    assert output.count("\n") == 1


@pytest.mark.parametrize(
    ("command", "arguments"),
    [
        ("retarget", ("clip.bvh", "--to", "165cm", "--out", "none/out.bvh")),
        ("tune", ("--out", "none/out.json")),
        ("walk", ("fit", "walks.csv", "--out", "none/out.npz")),
        ("reach", ("fit", "hands.csv", "--out", "none/out.npz")),
    ],
)
def test_a_missing_output_folder_is_reported_before_the_work(
    command: str, arguments: tuple[str, ...], folder: Path
) -> None:
    """A missing output folder is reported before any long work begins."""
    assert f"there is no folder {folder / 'none'}" in Invoked(command).refusal(*arguments)


@pytest.mark.parametrize("link", [False, True])
@pytest.mark.parametrize("what", sorted(SAME))
def test_a_file_that_is_read_is_not_written_over(what: str, folder: Path, *, link: bool) -> None:
    """An output that is one of the inputs is refused before any work, also through a link."""
    name, arguments = SAME[what]
    before = (folder / name).read_bytes()
    out = folder / f"link{Path(name).suffix}"
    if link:
        out.symlink_to(folder / name)
    told = Invoked(what.split()[0]).refusal(
        *what.split()[1:-1], *arguments, "--out", out if link else name
    )
    assert f"that is {name}, which is read, and it would be lost: name another file" in told
    assert (folder / name).read_bytes() == before


@pytest.mark.parametrize(
    ("command", "read", "title"),
    [("walk", "walks.csv", "a walking model"), ("reach", "head.csv", "a file of how people reach")],
)
def test_only_a_model_of_the_same_kind_is_replaced(
    command: str, read: str, title: str, folder: Path
) -> None:
    """A fit does not replace a file that holds something else than what it writes."""
    (folder / "notes.npz").write_text("to keep")
    told = Invoked(command).refusal("fit", read, "--out", "notes.npz")
    assert f"--out notes.npz: there is a file already that is not {title}" in told
    assert (folder / "notes.npz").read_text() == "to keep"


def test_every_file_parameter_of_every_command_is_tested() -> None:
    """Every file parameter of every command is listed in this module."""
    found = {
        f"{name} {parameter}"
        for name, command in _commands(app)
        for parameter, hint in get_type_hints(command).items()
        if Path in (hint, *get_args(hint))
    }
    assert len(found) > len(READ) / 2
    assert found <= READ.keys() | WRITTEN


def _commands(group: typer.Typer, name: str = "") -> Iterator[tuple[str, Callable[..., object]]]:
    for one in group.registered_commands:
        assert one.callback is not None
        yield f"{name} {one.name or one.callback.__name__}".strip(), one.callback
    for below in group.registered_groups:
        assert below.typer_instance is not None
        yield from _commands(below.typer_instance, f"{name} {below.name}".strip())


def test_other_file_errors_are_explained_without_numbers(tmp_path: Path) -> None:
    """A folder in place of a file, a file in place of a folder and denied access are explained."""
    (tmp_path / "file").touch()
    for path, words in (
        (tmp_path, "is a folder, where a file is needed"),
        (tmp_path / "file" / "below", "part of that path is a file"),
        (tmp_path / "none" / "below", f"there is no folder {tmp_path / 'none'}"),
    ):
        with pytest.raises(OSError, match="Errno") as raised:
            path.read_text()
        assert words in file_problem(raised.value)
        assert "Errno" not in file_problem(raised.value)
    denied = PermissionError(13, "Permission denied", "kept.csv")
    assert file_problem(denied).startswith("kept.csv cannot be opened")


def test_a_folder_in_place_of_a_file_is_refused(folder: Path) -> None:
    """A folder given in place of a file is refused with a readable error."""
    result = Invoked("score").run(folder, "--instrument", "karas2020")
    assert result.exit_code == UNUSABLE
    assert "is a folder" in result.stderr
