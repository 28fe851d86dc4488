"""Tests that every command in the docs works as described, or at least succeeds.

Commands of blocks run page by page, in order, in a folder with the files that they name: in this
process if they are a command of `reembody`, else against a real server. Slow commands run in a
brief form (BRIEF). Commands in sentences are checked: each command, option, path and script that
they name exists.
"""

import json
import os
import re
import shutil
import subprocess
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path

import httpx2
import numpy as np
import pytest
import typer
from typer.core import TyperGroup
from typer.testing import CliRunner

from app.adapters.captures.bvh_export import to_bvh
from app.cli.commands import app
from app.cli.tracking.inputs import write_poses
from app.clock import Clock
from app.features.movement.avatar import NewAvatar, create_avatar
from app.protocol.avatar import file_of
from app.science.avatar.mjcf import default_configuration
from app.science.reaching import Reacher
from app.science.retargeting import reference_avatar
from app.science.walking.synthetic import POPULATIONS, person_of, straight_path, walk_along
from tests.benchmarks.__main__ import NAMES, parser
from tests.docs.commands import Command, Fate, commands, mentions
from tests.docs.markdown import DOCS, REPOSITORY
from tests.features.lab import Lab as RunningLab
from tests.features.lab import running_lab
from tests.rehearsal.performed import STUDY, Lengths
from tests.science.alignment.rooms import OPTICAL, looking_around, recorded, some_room
from tests.science.reaching.reachers import Planted, as_tracker_file, hand_of
from tests.science.retargeting.walks import made_walk
from tests.support.lan import LanServer
from tests.support.server import ADMIN_PASSWORD, LiveServer, free_port
from tests.support.sqlite import fresh_sqlite

CLI = typer.main.get_command(app)
BY_PAGE = {
    page: [command for command in commands() if command.page == page and command.fate is Fate.RUN]
    for page in dict.fromkeys(command.page for command in commands())
}
COHORT = rf"\./run pilot {STUDY}"
BRIEF_PHASES = Lengths(2.0, 4.0, 0.5)
FAST_WALKING = ("--entries", "300", "--k", "30", "--reading", "time-aware")


class Lab:
    """A working folder with its own installation, and the files that a page names.

    `server`: a server on whose data the commands work; if None, they work on a data folder without
    a running server.
    """

    def __init__(self, folder: Path, shared_data: Path, server: LiveServer | None = None) -> None:
        self.folder = folder
        self.usb = folder / "usb"
        self.data = server.data_dir if server else folder / "data"
        self.server = server
        self.token = _token(self.data) if server else ""
        self._shared = shared_data
        self.usb.mkdir()

    def fill(self, command: Command) -> None:
        """Create the files that a command reads, unless an earlier command of the page did."""
        for pattern, make in {
            r"walk\.bvh": self._walk,
            r"02_01\.amc": self._amc,
            r"data\.csv": self._tidy,
            r"walks/": self._walks,
            r"reaches/": self._reaches,
            r"headset\.csv": self._two_systems,
            r"answers\.csv": self._answers,
            r"my-scene\.yaml": self._scene,
            r"our-room\.yaml": self._room,
            COHORT: self._brief_study,
        }.items():
            if re.search(pattern, command.text):
                make()

    def _walk(self) -> None:
        (self.folder / "walk.bvh").write_text(to_bvh(made_walk(reference_avatar(1.75)).motion))

    def _amc(self) -> None:
        for name in ("02_01.amc", "02.asf"):
            shutil.copy(self._shared / "motion" / "cmu_asfamc" / name, self.folder)

    def _tidy(self) -> None:
        rng = np.random.default_rng(1)
        rows = [
            f"P{person},{latency},{limb},{rng.integers(1, 8)},{rng.integers(1, 8)}"
            for person in range(8)
            for latency in (0, 125, 350)
            for limb in ("hand", "foot")
        ]
        (self.folder / "data.csv").write_text(_table("person,latency,limb,agency,score", rows))

    def _walks(self) -> None:
        statures = [f"{number},{1.7 + 0.05 * number}" for number in range(4)]
        (self.folder / "people.csv").write_text(_table("subject,stature_m", statures))
        for number in range(4):
            folder = self.folder / ("walks" if number < 2 else "others")
            folder.mkdir(exist_ok=True)
            rng = np.random.default_rng((4, number))
            person = person_of(POPULATIONS[0], number, rng)
            for length, load_kg in ((1.0, 0), (3.0, 8)):
                track = walk_along(person, straight_path(length), rng)
                moments = zip(track.times_s[::2], track.xy_m[::2], strict=True)
                rows = [f"{number},{t:.4f},{x:.4f},{y:.4f},{load_kg}" for t, (x, y) in moments]
                text = _table("subject,time_s,x_m,y_m,load_kg", rows)
                (folder / f"walker-{number}-{length:g}.csv").write_text(text)

    def _reaches(self) -> None:
        (self.folder / "reaches").mkdir()
        (self.folder / "hands.csv").write_text(
            _table("file,subject,width_m", [f"{at}.csv,P{at},0.1" for at in range(3)])
        )
        for at in range(3):
            rng = np.random.default_rng((6, at))
            track = hand_of(Planted(1.0 + 0.2 * at), Reacher("", ""), rng, count=6)
            (self.folder / "reaches" / f"{at}.csv").write_text(as_tracker_file(track))

    def _two_systems(self) -> None:
        rng = np.random.default_rng(3)
        headset, tracker = recorded(looking_around(12.0), some_room(rng), OPTICAL, rng)
        for name, poses in (("headset", headset), ("tracker", tracker), ("foot", tracker)):
            write_poses(self.folder / f"{name}.csv", poses)

    def _scene(self) -> None:
        shown = re.search(
            r"```yaml\n(key: my-scene.*?)```", (DOCS / "crossing.md").read_text(), re.S
        )
        assert shown is not None
        (self.folder / "my-scene.yaml").write_text(shown[1])

    def _room(self) -> None:
        (self.folder / "our-room.yaml").write_text(
            "key: our-room\n"
            "bounds_m: [0, 0, 4, 4]\n"
            "places: {door: [0.5, 2.0], boxes: [3.5, 2.0]}\n"
            "paths: [{name: to the boxes, from: door, to: boxes}]\n"
            "obstacles: [{name: desk, shape: box, center_m: [2, 3.5], size_m: [1, 0.5]}]\n"
        )

    def _brief_study(self) -> None:
        (self.folder / "brief.yaml").write_text(BRIEF_PHASES.text(), encoding="utf-8")

    def _answers(self) -> None:
        items = [f"q{number}" for number in range(1, 15)]
        text = _table(",".join(["person", *items]), [",".join(["P1", *["4"] * 14])])
        (self.folder / "answers.csv").write_text(text)


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[LiveServer]:
    """Provide the server that `./run` starts, with a study that takes seconds to rehearse."""
    with LiveServer(tmp_path_factory.mktemp("docs")) as running:
        BRIEF_PHASES.store(running)
        yield running


@pytest.mark.parametrize("page", [page for page, found in BY_PAGE.items() if found])
def test_the_commands_of_a_page_run_in_their_order(
    page: str,
    tmp_path: Path,
    request: pytest.FixtureRequest,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Each command of a page succeeds, and later ones find the results of earlier ones."""
    with_server = page in {"README.md", "docs/commands.md", "docs/captures.md"}
    lab = Lab(
        tmp_path,
        request.getfixturevalue("shared_data"),
        request.getfixturevalue("server") if with_server else None,
    )
    if not with_server:
        with running_lab(_database(lab), data_dir=lab.data) as running:
            if page == "docs/avatar.md":
                _add_an_arm(running)
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("REEMBODY_DATABASE_URL", raising=False)
    for command in BY_PAGE[page]:
        lab.fill(command)
        if PREPARED.get(command.text) == "an empty data folder":
            shutil.move(lab.data, tmp_path / "data-before")
        _run(command, lab, monkeypatch)


PREPARED = {"./run restore /media/usb/2026-11-21.reembody": "an empty data folder"}
"""The state that a page requires before a command."""
BRIEF = {
    r"\./run walk fit": FAST_WALKING,
    r"\./run pilot power": ("--sets", "20"),
    COHORT: ("--participants", "2", "--avatar", "delayed_copy"),
    r"\./run pilot merge people": ("--study", "brief.yaml"),
    # The last one wins: an avatar of which only one arm moves.
    r"\./run tune": ("--avatar", "arm"),
}
"""Arguments that are added so that a command takes only seconds."""


def _run(command: Command, lab: Lab, monkeypatch: pytest.MonkeyPatch) -> None:
    words = [_put_in_place(word, lab) for word in command.words]
    if re.match(COHORT, command.text):
        words[2] = "brief.yaml"
    if words[0] != "./run":
        _in_a_shell(command, lab)
    elif len(words) == 1 or words[1] == "serve" or words[1].startswith("-"):
        _serve(words[1:], command.settings, lab)
    else:
        there = lab.folder / command.settings.get("REEMBODY_DATA_DIR", lab.data)
        monkeypatch.setenv("REEMBODY_DATA_DIR", str(there))
        extra = [
            *(word for pattern, more in BRIEF.items() if re.match(pattern, command.text)
              for word in more),
            *_rehearsed_at(lab, command),
        ]  # fmt: skip
        done = CliRunner().invoke(app, [*_spread(words[1:], lab.folder), *extra])
        assert done.exit_code == 0, f"{command.page}:{command.line}: {command.text}\n{done.output}"


def _rehearsed_at(lab: Lab, command: Command) -> list[str]:
    """Return options for a running server and a brief study, else a rehearsal starts a server."""
    if not re.match(r"\./run rehearse", command.text):
        return []
    assert lab.server is not None
    return ["--url", lab.server.url, "--token", lab.token, "--study", BRIEF_PHASES.key]


def _put_in_place(word: str, lab: Lab) -> str:
    """Replace the placeholders of a page with real values."""
    if word == "SESSION_ID":
        (session, *_) = _ask(lab, f"/api/studies/{BRIEF_PHASES.key}/sessions")
        return str(session["id"])
    if word == "SEQ:HASH":
        backup = lab.folder / "for-its-head.reembody"
        done = CliRunner().invoke(app, ["backup", str(backup)])
        return str(re.findall(r"\d+:[0-9a-f]{64}", done.output)[0])
    return word.replace("/media/usb", str(lab.usb))


def _spread(words: list[str], folder: Path) -> list[str]:
    """Expand `*` in arguments as a shell does."""
    return [
        name
        for word in words
        for name in (sorted(map(str, folder.glob(word))) if "*" in word else [word])
    ]


def _serve(arguments: list[str], settings: Mapping[str, str], lab: Lab) -> None:
    """Start the server of a command line on free ports of the loopback, and request its page."""
    given = [word for word in arguments if word != "serve"]
    if "--port" in given:
        del given[(at := given.index("--port")) : at + 2]
    if lab.server and not given:
        _opens(lab.server)
        return
    if "--lan" not in given:
        folder = lab.folder / settings["REEMBODY_DATA_DIR"]
        with LiveServer(lab.folder, environment={"REEMBODY_DATA_DIR": str(folder)}) as running:
            _opens(running)
        return
    given.remove("--lan")
    if "--certificate" in given:
        # The built-in authority replaces the institute's.
        with LanServer(_fresh(lab.folder / "authority")) as authority:
            tls = authority.data_dir / "tls"
            _split(tls, lab.folder)
        given = [str(lab.folder / word) if word.endswith(".pem") else word for word in given]
    with (
        LanServer(_fresh(lab.folder / f"lan-{free_port()}"), arguments=given) as running,
        httpx2.Client(base_url=running.secure_url, verify=False) as device,
    ):
        assert "Reembody" in device.get("/").raise_for_status().text


def _opens(server: LiveServer) -> None:
    with server.client() as client:
        assert "Reembody" in client.get("/").raise_for_status().text


def _split(tls: Path, folder: Path) -> None:
    """Write the two files that `--certificate` and `--key` expect."""
    text = "".join(path.read_text() for path in sorted(tls.glob("server*.pem")))
    blocks = re.findall(r"-----BEGIN [^-]+-----.*?-----END [^-]+-----\n", text, re.DOTALL)
    (folder / "key.pem").write_text("".join(block for block in blocks if "KEY" in block))
    (folder / "chain.pem").write_text("".join(block for block in blocks if "KEY" not in block))


def _in_a_shell(command: Command, lab: Lab) -> None:
    if shutil.which("curl") is None:
        pytest.skip("curl is not installed")
    assert lab.server is not None
    text = command.text.replace("http://localhost:8321", lab.server.url)
    done = subprocess.run(
        ["sh", "-euc", text.replace("curl ", "curl --fail-with-body --silent --show-error ")],
        env={"PATH": os.environ["PATH"], "TOKEN": lab.token},
        cwd=lab.folder,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert json.loads(done.stdout)["id"]


@pytest.mark.long
def test_the_structure_is_measured_from_a_shell() -> None:
    """`python -m tests.architecture` runs from a shell, as docs/architecture.md shows it."""
    done = subprocess.run(
        [REPOSITORY / ".venv" / "bin" / "python", "-m", "tests.architecture"],
        cwd=REPOSITORY,
        capture_output=True,
        text=True,
        check=True,
    )
    assert "code lines" in done.stdout


@pytest.mark.long
def test_a_server_starts_on_postgresql(tmp_path: Path, postgres_url: str) -> None:
    """A server starts on PostgreSQL with the variable shown in docs/postgresql.md."""
    (shown,) = [command for command in commands() if command.page == "docs/postgresql.md"]
    (name,) = shown.settings
    with LiveServer(tmp_path, environment={name: postgres_url}) as running:
        _opens(running)


def test_every_command_has_an_example_that_runs() -> None:
    """Every command of `reembody` has an example in the docs that the usual run executes."""
    groups = {name.split()[0] for name in _names(CLI) if " " in name}
    shown = {
        " ".join(words[: 2 if words[0] in groups else 1])
        for command in commands()
        if command.fate is Fate.RUN and command.words[0] == "./run" and len(command.words) > 1
        for words in [_in_full(command.words[1:])]
    }
    assert sorted(_names(CLI) - shown) == []


def test_few_commands_are_shown_without_being_run() -> None:
    """At most a quarter of the commands in the docs are shown without being run."""
    not_run = [command for command in commands() if command.fate is Fate.NOT_RUN]
    assert len(not_run) <= len(commands()) / 4


def _checked() -> list[Command]:
    not_run = [command for command in commands() if command.fate is Fate.NOT_RUN]
    return [*not_run, *mentions()]


@pytest.mark.parametrize("page", sorted({command.page for command in _checked()}))
def test_everything_that_a_pages_commands_name_exists(page: str) -> None:
    """Commands, options, tests, benchmarks, modules and scripts that a page names exist."""
    wrong = [
        f"{command.page}:{command.line}: {command.text}: {problem}"
        for command in _checked()
        if command.page == page and (problem := _problem_of(command))
    ]
    assert wrong == []


def _problem_of(command: Command) -> str | None:
    text = re.sub(r"^(?:[A-Z_]+=\S+ +)+", "", command.text)
    words = re.sub(r"[\[\]]", "", text).split()
    match words:
        case ["adb" | "curl", *_] | ["./run" | "reembody"]:
            return None
        case ["cd", "frontend", "&&", "npm", "run", script, *_] | ["npm", "run", script, *_]:
            scripts = json.loads((REPOSITORY / "frontend" / "package.json").read_text())["scripts"]
            return None if script in scripts else f"no script {script}"
        case ["python", "-m", module, *_]:
            file = REPOSITORY / module.replace(".", "/")
            there = file.with_suffix(".py").exists() or (file / "__main__.py").exists()
            return None if there else f"no module {module}"
        case ["./run" | "reembody", "bench", *arguments]:
            return _problem_of_bench(arguments)
        case ["./run", "test" | "check", *arguments]:
            paths = [word for word in arguments if "/" in word]
            missing = [path for path in paths if not (REPOSITORY / path).exists()]
            return f"no {missing[0]}" if missing else None
        case ["./run" | "reembody", *arguments]:
            return _problem_of_reembody(arguments)
    return "what is this?"


def _problem_of_bench(arguments: list[str]) -> str | None:
    if (
        arguments[:1] not in ([], ["NAME"], ["all"], ["..."], ["--help"])
        and arguments[0] not in NAMES
    ):
        return f"no benchmark {arguments[0]}"
    known = {option for action in parser()._actions for option in action.option_strings}
    unknown = [word for word in arguments if word.startswith("--") and word not in known]
    return f"no option {unknown[0]}" if unknown else None


def _problem_of_reembody(arguments: list[str]) -> str | None:
    """Return the problem of words that are not a command; placeholders match anything."""
    if arguments[0] == "COMMAND" or arguments == ["--help"]:
        return None
    found = CLI
    options = {"--help"}
    words = _in_full(arguments)
    for word in words:
        names = word.split("|")
        if isinstance(found, TyperGroup) and not word.startswith("-"):
            if unknown := [name for name in names if name not in found.commands]:
                return f"no command {unknown[0]}"
            found = found.commands[names[0]]
        options |= {name for parameter in found.params for name in parameter.opts}
        if word.startswith("--") and word not in options:
            return f"no option {word}"
    return None


def _in_full(words: list[str]) -> list[str]:
    """Put in what may be left out: `serve`, and `cohort` between `pilot` and a study."""
    if words[0].startswith("-"):
        return ["serve", *words]
    if words[:2] in (["pilot", "STUDY"], ["pilot", STUDY]):
        return ["pilot", "cohort", *words[1:]]
    return words


def _names(group: object, before: str = "") -> set[str]:
    if not isinstance(group, TyperGroup):
        return {before.strip()}
    return {name for key, one in group.commands.items() for name in _names(one, f"{before} {key}")}


def _database(lab: Lab) -> str:
    lab.data.mkdir()
    return fresh_sqlite(lab.data / "reembody.sqlite")


def _add_an_arm(lab: RunningLab) -> None:
    """Store an avatar of which only one arm moves, so that most experiments are left out."""
    held = ("trunk_head", "left_leg", "right_leg", "right_arm", "left_fingers", "right_fingers")
    arm = file_of(replace(default_configuration(), locked_groups=held))
    wish = NewAvatar(key="arm", title="Arm", origin="by_hand", configuration=arm)
    with lab.database.writing() as db:
        create_avatar(db, "tester", wish, Clock().utc_now())


def _token(data: Path) -> str:
    done = CliRunner().invoke(app, ["token"], env={"REEMBODY_DATA_DIR": str(data)})
    assert done.exit_code == 0, done.output
    return done.stdout.strip()


def _ask(lab: Lab, path: str) -> list[dict[str, str]]:
    assert lab.server is not None
    with lab.server.client() as client:
        credentials = {"username": "admin", "password": ADMIN_PASSWORD}
        client.post("/api/login", json=credentials).raise_for_status()
        found: list[dict[str, str]] = client.get(path).raise_for_status().json()
    return found


def _table(head: str, rows: list[str]) -> str:
    return "\n".join([head, *rows]) + "\n"


def _fresh(folder: Path) -> Path:
    folder.mkdir()
    return folder
