"""Run `reembody tune`: find better gains for a configuration."""

import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

from app.cli.avatars import check_key, lab_database
from app.cli.errors import warn
from app.cli.outputs import require_output
from app.cli.tune.storage import save_tuned, stored_avatar
from app.database import Database
from app.protocol.avatar import avatar_text
from app.science.avatar.body import Figure
from app.science.avatar.configuration import Configuration
from app.science.avatar.mjcf import default_configuration
from app.science.avatar.tuning import (
    Assessment,
    Followed,
    TuningOptions,
    TuningProgress,
    TuningReport,
    assess,
    follow_capture,
)
from app.science.avatar.tuning import tune as tune_avatar
from app.science.skeleton import Movement, build_skeleton, resample
from app.whole_files import NotWritten, write_whole

_RATE_HZ = 90.0
"""The frame rate of a headset."""
_PHASES = {"relay": "relay experiment", "steps": "step on the whole body"}


@dataclass(frozen=True)
class TuneOrder:
    """The options of the command `tune`."""

    avatar: str | None
    stature_m: float
    mass_kg: float | None
    heuristic: str
    mirror: bool
    evaluate: bool
    axes: tuple[str, ...] | None
    attempts: int
    relay_torques: tuple[str, ...]
    workers: int
    capture: Path | None
    out: Path | None
    save: str | None


@dataclass(frozen=True)
class Tuned:
    """The result of the command `tune`.

    Attributes:
        order: the options.
        report: of the tuning, or of the unchanged gains with --evaluate.
        tracking: of the capture, if there was one.
        cpu_s: processor time of the tuning.
        saved: the version that was stored, as `key, version n`.
    """

    order: TuneOrder
    report: TuningReport | Assessment
    tracking: Followed | None
    cpu_s: float
    saved: str | None


def carry_out(order: TuneOrder) -> Tuned:
    """Tune a configuration, then write and store it as requested.

    Raises ValueError if the options do not allow a tuning, ReembodyError for an unknown avatar or
    an unusable database, OSError if the file cannot be written, TuningCancelled.
    """
    for_all_nm, by_axis_nm = _relay_torques(order.relay_torques)
    options = TuningOptions(
        heuristic=order.heuristic,
        mirror=order.mirror,
        attempts=order.attempts,
        workers=order.workers,
        relay_torque_nm=for_all_nm,
        relay_torques_nm=by_axis_nm,
        axes=order.axes,
    )
    if order.evaluate and order.axes is not None:
        raise ValueError("--evaluate tests every free axis, so --axis has no effect")
    if order.evaluate and order.relay_torques:
        raise ValueError("--evaluate makes no relay experiment, so --relay-torque has no effect")
    if order.evaluate and (order.save is not None or order.out is not None):
        raise ValueError("--evaluate changes nothing, so there is nothing to --save or write --out")
    require_output(order.out, order.capture)
    if order.save is None and order.avatar is None:
        return _carried_out(order, options, None)
    if order.save is not None:
        check_key("--save", order.save)
    with lab_database("tune") as database:
        return _carried_out(order, options, database)


def _relay_torques(given: tuple[str, ...]) -> tuple[float | None, dict[str, float]]:
    """Return the torque for all axes, if there is one, and those of single axes."""
    for_all_nm: float | None = None
    by_axis_nm: dict[str, float] = {}
    for text in given:
        axis, _, number = text.rpartition("=")
        try:
            torque_nm = float(number)
        except ValueError:
            raise ValueError(
                f"--relay-torque {text!r} is no torque: a number of N m such as 20 is valid, or"
                " one for an axis such as LeftUpperLegX=20"
            ) from None
        if axis:
            by_axis_nm[axis.strip()] = torque_nm
        else:
            for_all_nm = torque_nm
    return for_all_nm, by_axis_nm


def _carried_out(order: TuneOrder, options: TuningOptions, database: Database | None) -> Tuned:
    configuration, figure, number = _avatar(order, database)
    # Read the capture first, so that an error is reported before the tuning.
    movement = None if order.capture is None else _movement(order.capture, order.stature_m)
    started_s = time.process_time()
    with _interruptible() as interrupted, show_progress() as progress:
        work: Callable[..., TuningReport | Assessment] = assess if order.evaluate else tune_avatar
        report = work(
            configuration,
            order.stature_m,
            options,
            figure=figure,
            wall_s=time.monotonic,
            progress=progress,
            cancelled=interrupted,
        )
    cpu_s = time.process_time() - started_s
    tracking = None
    if movement is not None:
        tracking = follow_capture(report.configuration, order.stature_m, movement, figure=figure)
    unwritten = _unwritten(order.out, report.configuration)
    saved = None
    if database is not None and order.save is not None and isinstance(report, TuningReport):
        saved = save_tuned(database, order.save, report, tracking)
        if order.avatar == order.save and number is not None and saved.number > number + 1:
            warn(
                f"{order.save}@{saved.number - 1} was saved during the tuning, which began from"
                f" {order.save}@{number}, so its changes are not in the tuned version; see reembody"
                f" avatar diff {order.save}@{number} {order.save}@{saved.number - 1}"
            )
    if unwritten is not None:
        if saved is None:
            raise unwritten
        raise ValueError(f"{unwritten} The tuning is not lost: {saved.name} is stored.")
    return Tuned(order, report, tracking, cpu_s, None if saved is None else saved.name)


def _unwritten(out: Path | None, configuration: Configuration) -> NotWritten | None:
    """Write the file; return why it cannot be written, as the tuning may still be stored."""
    try:
        if out is not None:
            write_whole(out, avatar_text(configuration))
    except NotWritten as error:
        return error
    return None


def _avatar(
    order: TuneOrder, database: Database | None
) -> tuple[Configuration, Figure | None, int | None]:
    found, figure, number = default_configuration(), None, None
    if database is not None and order.avatar is not None:
        found, figure, number = stored_avatar(database, order.avatar)
    if order.mass_kg is not None:
        found = replace(found, total_mass_kg=order.mass_kg)
    return found, figure, number


def _movement(capture: Path, stature_m: float) -> Movement:
    from app.simulated_people.body import captured_movement

    return resample(captured_movement(capture, build_skeleton(stature_m)), _RATE_HZ)


@contextmanager
def _interruptible() -> Iterator[Callable[[], bool]]:
    """Make Ctrl-C ask the experiments to end, instead of interrupting one."""
    requested = threading.Event()
    if threading.current_thread() is not threading.main_thread():
        yield requested.is_set
        return
    before = signal.signal(signal.SIGINT, lambda *_: requested.set())
    try:
        yield requested.is_set
    finally:
        signal.signal(signal.SIGINT, before)


@contextmanager
def show_progress() -> Iterator[Callable[[TuningProgress], None]]:
    """Show progress: on a terminal one line that is overwritten, elsewhere a line per phase."""
    live = sys.stderr.isatty()
    yield _show_live if live else _show_phases
    if live:
        sys.stderr.write("\r\033[K")
        sys.stderr.flush()


def _show_live(at: TuningProgress) -> None:
    sys.stderr.write(f"\r\033[K{_line(at)}  {at.axis}")
    sys.stderr.flush()


def _show_phases(at: TuningProgress) -> None:
    if at.done == at.total:
        sys.stderr.write(f"{_line(at)}\n")


def _line(at: TuningProgress) -> str:
    return f"attempt {at.attempt}, {_PHASES[at.phase]}: {at.done} of {at.total} axes"
