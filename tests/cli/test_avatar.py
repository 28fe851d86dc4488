"""Tests of `reembody avatar`: show, edit, compare, convert, save and load configurations."""

import json
import sqlite3
from contextlib import closing
from pathlib import Path
from threading import Timer

import pytest

from app.cli.avatars import lab_database, written
from app.errors import NotNow
from app.features.movement.avatar.service import newest_numbers, shipped_configurations
from app.protocol.avatar import avatar_text, load_avatar, loaded, single_text
from app.protocol.avatar_editing import edited, read_operations
from app.science.avatar.configuration import Configuration, joined, mirrored, with_global
from tests.cli.invoked import Invoked
from tests.protocol.test_avatar_editing import functions_of_the_thesis
from tests.support.small_files import small_files

_COMMAND = Invoked("avatar")
_run, _figures, _refusal = _COMMAND.run, _COMMAND.figures, _COMMAND.refusal
FIRST, NEWEST = shipped_configurations()
SOFT_ARM = '{"operation": "set_gains", "targets": ["left_arm"], "kp_nm_per_rad": 50}'
HEADLESS = '{"operation": "remove_parts", "targets": ["Head"]}'
MIRROR = '{"operation": "mirror", "direction": "left_to_right"}'


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return the folder of a new installation."""
    monkeypatch.setenv("REEMBODY_DATA_DIR", str(tmp_path / "data"))
    monkeypatch.delenv("REEMBODY_DATABASE_URL", raising=False)
    (tmp_path / "data").mkdir()
    return tmp_path


def test_an_edit_is_written_stored_compared_and_loaded(folder: Path) -> None:
    """Operations give the content of the functions in Python, in a file and as a version."""
    out, back = folder / "soft.json", folder / "back.json"
    expected = mirrored(with_global(FIRST, group="left_arm", kp=50.0), "left_to_right")
    (folder / "mirror.json").write_text(f"[{MIRROR}]")
    done = _figures(
        "edit", "standard@1", "--operation", SOFT_ARM, "--operation", MIRROR,
        "--out", out, "--save", "soft", "--note", "for the pilot",
    )  # fmt: skip
    assert done["content_hash"] == loaded(expected).content_hash
    assert (len(done["changed"]), done["lost"], done["written"]) == (18, [], str(out))
    assert out.read_text() == avatar_text(expected)
    assert (done["saved"]["version"], done["saved"]["note"]) == (1, "for the pilot")
    again = _figures("save", out, "soft")
    assert again["version"] == 1, "equal content is no new version"
    found = _figures("diff", "standard@1", "soft")
    assert [(one["group"], one["values"]) for one in found["groups"]] == [
        ("left_arm", 9),
        ("right_arm", 9),
    ]
    assert found["changed"] == done["changed"]
    _figures("load", "soft@1", "--out", back)
    assert back.read_bytes() == out.read_bytes()
    # A list prints JSON that is no object.
    listed = json.loads(_run("list", "--json").stdout)
    assert [(one["key"], len(one["versions"])) for one in listed] == [("soft", 1), ("standard", 2)]


@pytest.mark.usefixtures("folder")
def test_the_command_makes_every_function_of_the_thesis() -> None:
    """Each row of the table in the docs gives by the command what it gives in Python."""
    for function, operation in functions_of_the_thesis():
        done = _figures("edit", "standard", "--operation", json.dumps(operation))
        expected = edited(NEWEST, read_operations(json.dumps(operation)), _shipped)
        assert expected.problems == ()
        assert done["content_hash"] == loaded(expected.configuration).content_hash, function
        assert len(done["changed"]) == len(expected.changed)


def _shipped(key: str, number: int | None) -> Configuration:
    assert key == "standard"
    return FIRST if number == 1 else NEWEST


@pytest.mark.usefixtures("folder")
def test_configurations_are_printed_for_people() -> None:
    """Tables name units, a group can be chosen, and both templates can be shown."""
    text = _run("show", "standard@1", "--group", "LeftFoot").stdout
    assert "N m s/rad" in text
    assert [line.split()[0] for line in text.splitlines()[-3:]] == [
        "LeftFootX",
        "LeftFootZ",
        "LeftFootY",
    ]
    assert text.splitlines()[:2] == [
        "standard, version 1",
        "file format: reembody-avatar, version 1",
    ]
    single = _figures("show", "standard@1", "--group", "LeftFoot", "--single")
    assert (single["saved"], single["version"]) == ({"key": "standard", "version": 1}, 1)
    assert single["joints"]["LeftFoot"]["limits_deg"] == {"LeftFootZ": 35.0, "LeftFootY": 20.0}
    edited = _run("edit", "standard@1", "--operation", MIRROR, "--operation", SOFT_ARM).stdout
    assert "9 values differ." in edited
    assert "Nothing was written" in edited
    assert "standard  Standard" in _run("list").stdout
    assert "mirror: Copy one side" in _run("operations").stdout
    assert "set_layers" in _figures("operations")
    assert _run("diff", "standard", "standard@2").stdout == "They are the same.\n"


def test_a_template_is_converted_and_the_loss_is_told(folder: Path) -> None:
    """A file in the single template tells what it lost, and reads in every place."""
    single, multiple = folder / "single.json", folder / "multiple.json"
    told = _run("convert", "standard", "--to", "single", "--out", single).stdout
    assert "cannot be kept" in told
    expected = joined(NEWEST, NEWEST.parts)
    assert single.read_text() == single_text(expected)
    shown = _run("show", single).stdout.splitlines()[:2]
    assert shown == [str(single), "file format: reembody-avatar-single, version 1"]
    done = _figures("convert", single, "--to", "multiple", "--out", multiple)
    assert (done["lost"], done["content_hash"]) == ([], loaded(expected).content_hash)
    assert load_avatar(multiple.read_text()).configuration == expected


def test_refusals_say_what_to_do_and_write_nothing(folder: Path) -> None:
    """Each wrong input is refused with its reason; no file and no version is written."""
    out = folder / "out.json"
    (folder / "broken.json").write_text("{")
    for arguments, said in (
        (("edit", "standard"), "there is nothing to do"),
        (("edit", "standard", "--operation", "{"), "not JSON"),
        (("edit", "standard", "--operation", '{"operation": "melt"}'), "set_gains"),
        (
            ("edit", "standard", "--operation", '{"operation": "set_gains", "targets": ["Tail"]}'),
            "There is no body group or axis 'Tail'",
        ),
        (
            (
                "edit",
                "standard",
                "--operation",
                '{"operation": "set_limits", "targets": ["HeadX"], "low_deg": 90}',
            ),
            "operation 1: axes.HeadX.low_deg: The lower limit, 90 deg",
        ),
        (("edit", "standard", "--operation", '{"operation": "load", "key": "no"}'), "no avatar"),
        (("show", "nobody"), "there is no avatar 'nobody'; valid: standard"),
        (("show", "standard@9"), "has no version 9"),
        (("show", "standard@x"), "after @ comes the number"),
        (("show", "standard@9999999999999999999999"), "from 1 to 1000000, as in standard@2"),
        (("show", "standard@\u00b2"), "after @ comes the number"),
        (("show", "standard@\u0661"), "after @ comes the number"),
        (("save", "/dev/zero", "new"), "more than 262144 bytes"),
        (("edit", "standard", "--operations", "/dev/zero"), "more than 262144 bytes"),
        (("show", "standard", "--group", "tail"), "There is no body group 'tail'"),
        (("show", folder / "broken.json"), "is not a valid configuration"),
        (("show", folder / "missing.json"), "missing.json"),
        (("save", folder / "broken.json", "Capital"), "a key begins with"),
        (("convert", "standard", "--to", "double"), "valid are single, multiple"),
        (("show", "standrad"), "Did you mean standard?"),
        (("show", "standard", "--group", "left_leq"), "Did you mean 'left_leg'?"),
        (("show", "standard@9"), "valid: 1 to 2"),
        (("edit", "standard", "--operation", '{"operation": "miror"}'), "Did you mean 'mirror'?"),
        (
            ("edit", "standard", "--operation", SOFT_ARM.replace("left_arm", "left_amr")),
            "targets[0]: There is no body group or axis 'left_amr'. Did you mean 'left_arm'?",
        ),
        (
            ("edit", "standard", "--operation", SOFT_ARM.replace("kp_nm_per_rad", "kp_nm")),
            "Did you mean 'kp_nm_per_rad'?",
        ),
        (
            ("edit", "standard", "--operation", SOFT_ARM.replace("50", "-50")),
            "-50 is out of range. Give a value at least 0.",
        ),
        (("convert", "standard", "--to", "singel"), "Did you mean 'single'?"),
        (("save", folder / "broken.json", "good", "--title", "\x01"), "control character"),
        (("edit", "standard", "--operation", HEADLESS, "--save", "headless"), "built without Head"),
        (("list", "--url", "http://127.0.0.1:9"), "needs --token"),
        (("list", "--token", "t"), "give its --url"),
        (("list", "--url", "127.0.0.1", "--token", "t"), "is no address of a server"),
        (("list", "--url", "http://127.0.0.1:9", "--token", "t"), "there is no answer from"),
    ):
        writes = arguments[0] in ("edit", "convert") and "--save" not in arguments
        extra = ("--out", out) if writes else ()
        assert said in _refusal(*arguments, *extra), arguments
    assert not out.exists()
    assert json.loads(_run("list", "--json").stdout)[0]["key"] == "standard"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ('{"format": "unity-joints", "joints": []}', "its format is 'unity-joints'"),
        ('{"asset": {"version": "2.0"}, "nodes": []}', "it does not name its format"),
        ("[1, 2]", "it has no keys"),
        ("not JSON", "no avatar configuration"),
        (
            avatar_text(FIRST).replace('"version": 1', '"version": 2'),
            "this release reads version 1",
        ),
        (avatar_text(FIRST).replace("72.0", "NaN"), "NaN is not a finite number"),
        (avatar_text(FIRST)[:900], "This is not JSON"),
        (avatar_text(FIRST).replace("[]", json.dumps(["left_leg"] * 60_000)), "more than 262144"),
    ],
)
def test_a_file_that_is_no_configuration_gets_one_reason(
    folder: Path, text: str, said: str
) -> None:
    """Another program's file, another version, NaN and a huge file are refused by one sentence."""
    file = folder / "file.json"
    file.write_text(text)
    told = _refusal("save", file, "new")
    assert said in told
    assert len(told.splitlines()) == 2
    assert [one["key"] for one in json.loads(_run("list", "--json").stdout)] == ["standard"]


def test_a_version_that_somebody_else_saved_is_not_taken_back(folder: Path) -> None:
    """A file made from an older version is refused with what it would undo, unless it is meant."""
    mine, theirs = folder / "mine.json", folder / "theirs.json"
    _figures("edit", "standard@1", "--operation", SOFT_ARM, "--save", "shared")
    told = _run("load", "shared", "--out", mine).stdout
    assert f"shared, version 1\nTo save it after an edit: reembody avatar save {mine}" in told
    assert told.endswith("shared --based-on 1\n")
    light = '{"operation": "set_masses", "total_mass_kg": 60}'
    saved = _run("edit", mine, "--operation", light, "--out", theirs, "--save", "shared").stdout
    assert "version 2" in saved
    assert "from version 1 differ:\n  total_mass_kg: 72 -> 60 kg" in saved
    mine.write_text(mine.read_text().replace('"gravity": true', '"gravity": false'))

    unknown = _refusal("save", mine, "shared")
    assert "it is not known from which one" in unknown
    assert "  total_mass_kg: 60 -> 72 kg\n  gravity: True -> False\n" in unknown
    stale = _refusal("save", mine, "shared", "--based-on", 1)
    assert stale.index("total_mass_kg: 72 -> 60 kg") < stale.index("total_mass_kg: 60 -> 72 kg")
    assert "Make your changes to shared@2, or give --based-on 2" in stale
    assert "has no version 3" in _refusal("save", mine, "shared", "--based-on", 3)
    assert "no avatar 'other'" in _refusal("save", mine, "other", "--based-on", 1)
    before = mine.read_text()
    old = ("edit", "shared@1", "--operation", MIRROR, "--save", "shared", "--out", mine)
    assert "right_arm: 9 values" in _refusal(*old)
    assert mine.read_text() == before, "no file is written either"

    again = _figures("save", theirs, "shared")
    assert (again["version"], again["before"], again["changed"]) == (2, 2, [])
    newest = _figures("edit", "shared", "--operation", MIRROR, "--save", "shared")["saved"]
    assert (newest["version"], newest["before"]) == (3, 2)
    meant = _figures("save", mine, "shared", "--based-on", 3, "--note", "heavy again")
    assert meant["version"] == 4
    assert [one["path"] for one in meant["changed"]][:2] == ["total_mass_kg", "gravity"]


def test_what_cannot_be_written_is_neither_cut_nor_stored(folder: Path) -> None:
    """On a full disk the only copy stays as it was, and no version is stored without its file."""
    only, newer = folder / "only.json", folder / "newer.json"
    _figures("load", "standard@1", "--out", only)
    _figures("load", "standard@2", "--out", newer)
    edits = ("edit", only, "--operation", SOFT_ARM, "--save", "soft")
    with small_files():
        for arguments in (
            (*edits[:4], "--out", only),
            ("convert", only, "--to", "single", "--out", only),
            ("load", newer, "--out", only),
        ):
            told = _refusal(*arguments)
            assert f"{only} was not written: its disk is full" in told
            assert "The file that is there is unchanged." in told
            assert only.read_text() == avatar_text(FIRST)
    assert "/dev/full was not written: its disk is full" in _refusal(*edits, "--out", "/dev/full")
    assert [one["key"] for one in json.loads(_run("list", "--json").stdout)] == ["standard"]
    assert sorted(one.name for one in folder.iterdir()) == ["data", "newer.json", "only.json"]


def test_saving_waits_for_others_that_write(folder: Path) -> None:
    """While another process writes, a command waits, and says so only if that takes too long."""
    _run("list")
    file = folder / "data" / "reembody.sqlite"
    with (
        lab_database("test") as database,
        closing(sqlite3.connect(file, isolation_level=None, check_same_thread=False)) as other,
    ):
        other.execute("BEGIN IMMEDIATE")
        with pytest.raises(NotNow, match="another program has been writing"):
            written(database, newest_numbers, wait_s=0.0)
        ends = Timer(0.3, other.execute, ("ROLLBACK",))
        ends.start()
        assert set(written(database, newest_numbers)) == {"standard"}
        ends.join()
