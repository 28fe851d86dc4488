"""What the worker process of a pilot runs: it goes on where it was, and waits while it is held."""

import errno
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass, field
from typing import Any, Final

from app.errors import as_sentences, file_problem
from app.features.results.pilot.folder import PilotFolder, StageProgress
from app.features.results.pilot.order import CannotSimulate, PilotOrder
from app.features.results.pilot.simulation import (
    CohortOrder,
    Curve,
    PilotStudy,
    PowerOrder,
    Progress,
    check_study,
    curve_data,
    form_texts,
    preregistration_texts,
    report_data,
    report_on,
    simulate_cohort,
    simulate_power,
)
from app.protocol import ConfigError, load_assumptions

Json = dict[str, Any]
LOOK_EVERY_S: Final = 0.5
"""How often a pilot looks whether it has to wait."""
NO_SPACE: Final = (errno.ENOSPC, errno.EDQUOT)


def run_pilot(order: PilotOrder, files: PilotFolder) -> Json:
    """Compute a pilot, with what is finished kept in its folder; raise CannotSimulate.

    Returns its summary: `report` of a cohort, `curve` of the power if anything is assumed,
    `preregistration`, a text with its figures by language, and `processor_s`.
    """
    course = _Course(files)
    try:
        summary = _cohort(order, files, course) if order.kind == "cohort" else None
        if summary is None:
            summary = _with_curve(None, _curve(order, files, course))
    except OSError as error:
        raise CannotSimulate(_told(error)) from None
    except ConfigError as error:
        raise CannotSimulate(as_sentences(*map(str, error.problems))) from None
    except ValueError as error:
        raise CannotSimulate(str(error)) from None
    return {**summary, "processor_s": time.process_time()}


@dataclass
class _Course:
    """Writes how far a pilot is, and waits while it is held."""

    files: PilotFolder
    monotonic_s: Callable[[], float] = time.monotonic
    sleep: Callable[[float], None] = time.sleep
    _looked_s: float = float("-inf")
    _waited_s: float = 0.0
    _began: tuple[str, int, float] | None = field(default=None)

    def pause(self) -> None:
        """Wait while the pilot is held; it looks from time to time only."""
        now_s = self.monotonic_s()
        if now_s - self._looked_s < LOOK_EVERY_S:
            return
        while self.files.is_held:
            self.sleep(LOOK_EVERY_S)
        self._looked_s = self.monotonic_s()
        self._waited_s += self._looked_s - now_s

    def tell(self, at: Progress) -> None:
        """Write the progress, and wait while the pilot is held."""
        now_s = self.monotonic_s() - self._waited_s
        if self._began is None or self._began[0] != at.stage:
            self._began = (at.stage, at.done, now_s)
        _, began_at, began_s = self._began
        new = at.done - began_at
        remaining_s = (now_s - began_s) / new * (at.total - at.done) if new else None
        self.files.write_progress(StageProgress(at.stage, at.done, at.total, remaining_s))
        self._looked_s = float("-inf")
        self.pause()


def _cohort(order: PilotOrder, files: PilotFolder, course: _Course) -> Json:
    study = PilotStudy(order.study, order.instruments)
    checked = check_study(study, course.tell)
    given = order.options
    people = simulate_cohort(
        study,
        CohortOrder(given["participants"], given["seed"], given["avatar"]),
        course.tell,
        record=files.cohort,
        pause=course.pause,
    )
    curve = None if order.assumptions is None else _curve(order, files, course)
    found = report_on(study, people, checked, curve)
    report = report_data(found) | {"ethics": form_texts(found)["ethics"]}
    # A resumed run knows only its own share of the time, so it is nobody's figure to keep.
    del report["real_time_factor"], report["paragraphs"]
    return _with_curve(report, curve)


def _with_curve(report: Json | None, curve: Curve | None) -> Json:
    return {
        "report": report,
        "curve": None
        if curve is None
        else curve_data(curve) | {"names": asdict(curve.names), "score_range": curve.score_range},
        "preregistration": preregistration_texts(curve),
    }


def _curve(order: PilotOrder, files: PilotFolder, course: _Course) -> Curve:
    study, given = PilotStudy(order.study, order.instruments), order.options
    loaded = load_assumptions(order.assumptions or "", order.study.protocol, order.instruments)
    asked = (
        PowerOrder(seed=given["seed"])
        if order.kind == "cohort"
        else PowerOrder(tuple(given["participants"]), given["seed"], given["sets"], given["target"])
    )
    return simulate_power(study, loaded, asked, course.tell, record=files.power)


def _told(error: OSError) -> str:
    if error.errno in NO_SPACE:
        return (
            "the disk of the data folder is full. Free some space, then resume it: what is "
            "finished is kept"
        )
    return f"its record cannot be written: {file_problem(error)}. Resume it when that is mended"
