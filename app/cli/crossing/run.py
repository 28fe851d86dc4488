"""Run `reembody crossing`: a scene with its partners, the example vehicle, the extra."""

import shutil
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from importlib.metadata import requires
from importlib.util import find_spec
from pathlib import Path

from app.adapters.cosimulation import (
    EXTRAS,
    CrossingScene,
    VehicleOrder,
    drive,
    load_scene,
    partners_of,
    shipped_scenes,
    sumo_folder,
)
from app.cli.outputs import require_output
from app.errors import missing_file
from app.protocol import ConfigError
from app.science.cosimulation import (
    Clocks,
    Conductor,
    CosimulationError,
    Crossing,
    Lane,
    Record,
    Timing,
    crossings,
)

LANES: dict[str, Lane] = {"near": "near", "far": "far"}


@dataclass(frozen=True)
class Done:
    """A scene that was run.

    Attributes:
        scene, seed: what was run.
        record: all states and guesses.
        timing: real times, which are no part of the record.
        crossings: how each person crossed.
        out: the written record, if any.
    """

    scene: CrossingScene
    seed: int
    record: Record
    timing: Timing
    crossings: tuple[Crossing, ...]
    out: Path | None


@dataclass(frozen=True)
class ListedScene:
    """An included scene; `missing` says what it needs that is not installed."""

    key: str
    title: str
    missing: str


def carry_out_run(
    key: str, seed: int, out: Path | None, *, real_time: bool, say: Callable[[str], None]
) -> Done:
    """Run a scene; raise ValueError or OSError if it cannot be.

    A lost partner is no error: its record ends there, is written, and says why.
    """
    require_output(out, key)
    scene = _scene(key)
    file = scene.file
    steps = max(1, round(file.duration_s / file.step_s))
    header = {
        "scene": file.key,
        "scene_sha256": scene.sha256,
        "seed": seed,
        "road": file.road.model_dump(),
        "partners": [
            {"name": one.name, "kind": one.kind, "step_s": one.step_s or file.step_s,
             "late": one.late.model_dump()}
            for one in file.partners
        ],
    }  # fmt: skip
    with partners_of(scene, seed) as (partners, to_start):
        for sentence in to_start:
            say(sentence)
        conductor = Conductor(partners, file.step_s, _clocks(real_time=real_time))
        record, timing = conductor.run(steps, header)
    if out is not None:
        _write(out, record)
    return Done(scene, seed, record, timing, crossings(record, scene.road), out)


def listed_scenes() -> list[ListedScene]:
    """Return the included scenes."""
    return [_listed(key, load_scene(path)) for key, path in shipped_scenes().items()]


def carry_out_vehicle(
    connect: str, name: str, lane: str, speed_m_s: float, fmu: Path | None
) -> None:
    """Drive the example vehicle; raise ValueError or OSError."""
    host, _, port = connect.rpartition(":")
    if not host or not port.isdecimal() or not 0 < int(port) < 65536:
        raise ValueError(f"--connect {connect!r}: give HOST:PORT, as in 127.0.0.1:47800")
    if lane not in LANES:
        raise ValueError(f"--lane {lane!r}: {' and '.join(LANES)} are valid")
    if fmu is not None:
        # A missing file is told even where the package that reads it is missing, too.
        fmu.open("rb").close()
    drive(VehicleOrder(name, host, int(port), LANES[lane], speed_m_s, fmu))


def listed_extras() -> str:
    """Return a line for each extra: whether it is installed, or the command that adds it."""
    return "\n".join(
        f"{extra}: installed"
        if all(find_spec(module) for module in modules)
        else f"{extra}: not installed; `reembody crossing install {extra}` adds it"
        for extra, modules in EXTRAS.items()
    )


def install_extra(extra: str) -> str:
    """Install the packages of an extra into this environment; return what to say.

    Raises:
        ValueError: there is no such extra, no installer, or it fails; its own messages say why.
    """
    if extra not in EXTRAS:
        raise ValueError(f"{extra!r}: the extras of scenes are {', '.join(EXTRAS)}")
    wanted = [
        text.partition(";")[0].strip()
        for text in requires("reembody") or ()
        if f'extra == "{extra}"' in text.replace("'", '"')
    ]
    command = [*_installer(wanted), *wanted]
    done = subprocess.run(command, check=False, stdout=sys.stderr)  # noqa: S603 - our own names
    if done.returncode:
        raise ValueError(f"{' '.join(wanted)} could not be installed; the reason is above")
    return f"installed: {', '.join(wanted)}"


def _installer(wanted: list[str]) -> list[str]:
    """Return the beginning of the command that installs packages into this environment."""
    if find_spec("pip") is not None:
        return [sys.executable, "-m", "pip", "install"]
    # `./run` makes environments with uv, which need no pip.
    beside = Path(sys.prefix).parent / ".uv" / "bin" / "uv"
    uv = shutil.which("uv") or (str(beside) if beside.is_file() else None)
    if uv is None:
        raise ValueError(
            f"there is neither pip nor uv: install {' '.join(wanted)} into the environment of"
            f" {sys.executable}"
        )
    return [uv, "pip", "install", "--python", sys.executable]


def _clocks(*, real_time: bool) -> Clocks:
    if not real_time:
        return Clocks(time.perf_counter)
    begun: list[float] = []

    def pace(scene_s: float) -> None:
        # The first step begins when all partners are there.
        begun.append(time.perf_counter()) if not begun else None
        time.sleep(max(0.0, begun[0] + scene_s - time.perf_counter()))

    return Clocks(time.perf_counter, pace)


def _scene(key: str) -> CrossingScene:
    shipped = shipped_scenes()
    path = shipped.get(key, Path(key))
    if not path.exists():
        raise ValueError(f"{missing_file(path)}; included scenes are {', '.join(shipped)}.")
    try:
        return load_scene(path)
    except ConfigError as error:
        problems = "; ".join(f"line {one.line}: {one.message}" for one in error.problems)
        raise ValueError(f"{path}: {problems}") from error
    except UnicodeDecodeError as error:
        raise ValueError(f"{path}: not UTF-8 text ({error})") from error


def _listed(key: str, scene: CrossingScene) -> ListedScene:
    missing = ""
    if any(one.kind == "sumo" for one in scene.file.partners):
        try:
            sumo_folder()
        except CosimulationError as error:
            missing = str(error)
    return ListedScene(key, scene.file.title, missing)


def _write(out: Path, record: Record) -> None:
    """Write a record beside its place and move it there, so that there is never half of one."""
    part = out.with_name(out.name + ".part")
    part.write_bytes(record.content)
    part.replace(out)
