"""The measures that are tested: one value per participant, limb and latency, or body.

Only valid rows of valid completed sessions are tested. A value is the mean of a participant's rows
in one cell of the design. Participants without a cell are left out of the tests that need all of
them, and are listed with the reason.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd

from app.features.results.analysis.figures.by_latency import LATENCY, per_participant
from app.features.results.analysis.figures.fingers import finger_angles
from app.features.results.analysis.figures.joint_errors import task_angles
from app.features.results.analysis.material import Material
from app.protocol import COUNTED_KINDS
from app.science.instruments import Instrument, names_in
from app.science.statistics import Direction, FloatArray

LIMBS = ("hand", "foot")
FALLS: frozenset[str] = frozenset({"agency"})
"""Scores that were predicted to fall with latency: Waltemate et al. 2016, and later work."""
_SHOWN = 12


@dataclass(frozen=True)
class Factor:
    """What conditions differ in: the added latency, or the body that participants wear.

    `column`: of the tables. `order`: the names of its levels; None for levels that are numbers and
    have an order of their own, so that a trend and a smallest level exist.
    """

    name: str
    plural: str
    column: str
    unit: str = ""
    order: tuple[str, ...] | None = None

    @property
    def heading(self) -> str:
        """Return the name as the heading of a column."""
        return f"{self.name} ({self.unit})" if self.unit else self.name

    def words(self, level: str) -> str:
        """Return a level as text with its unit."""
        return f"{level} {self.unit}" if self.unit else level


LATENCY_FACTOR = Factor("latency", "latencies", LATENCY.column, "ms")


def body_factor(bodies: Sequence[str]) -> Factor:
    """Return the factor of a study whose conditions differ in these bodies."""
    return Factor("body", "bodies", "body", order=tuple(bodies))


@dataclass(frozen=True, eq=False)
class Measure:
    """One measure of a study, such as a score or the contact time.

    `values` has the columns participant_code, limb, that of the factor, value; `places` has the
    block, too.
    `maximum`: the maximum of a score whose range is symmetric about 0. `continuous`: seconds,
    degrees and counts, for which means and models of means are meaningful.
    """

    key: str
    title: str
    unit: str
    about: str
    values: pd.DataFrame
    places: pd.DataFrame
    continuous: bool
    maximum: float | None = None
    predicted: Direction | None = None
    factor: Factor = LATENCY_FACTOR

    @property
    def latencies_ms(self) -> tuple[float, ...]:
        """Return the latencies in ascending order."""
        return tuple(sorted(float(one) for one in self.values[LATENCY.column].unique()))

    @property
    def _keys(self) -> tuple[float, ...] | tuple[str, ...]:
        """Return the levels of the factor as they are in the tables."""
        if self.factor.order is None:
            return self.latencies_ms
        used = set(self.values[self.factor.column])
        return tuple(level for level in self.factor.order if level in used)

    @property
    def levels(self) -> tuple[str, ...]:
        """Return the levels of the factor as text: latencies ascending, bodies as in the study."""
        return tuple(key if isinstance(key, str) else f"{key:g}" for key in self._keys)

    @property
    def limbs(self) -> tuple[str, ...]:
        """Return the limbs that have values."""
        return tuple(limb for limb in LIMBS if (self.values["limb"] == limb).any())

    def table(self, limb: str) -> pd.DataFrame:
        """Return the values as participants x levels, NaN where there is no value."""
        own = self.values[self.values["limb"] == limb]
        wide = own.pivot(index="participant_code", columns=self.factor.column, values="value")
        return wide.reindex(columns=list(self._keys)).sort_index()

    def cells(self) -> FloatArray:
        """Return the values (n, levels, limbs) of participants with a value in every cell."""
        tables = [self.table(limb) for limb in self.limbs]
        everybody = sorted(set().union(*(table.index for table in tables)))
        stacked = np.stack(
            [table.reindex(everybody).to_numpy(dtype=np.float64) for table in tables], axis=2
        )
        kept: FloatArray = stacked[np.isfinite(stacked).all(axis=(1, 2))]
        return kept

    def missing(self) -> list[str]:
        """Return sentences that say which participants lack which cells."""
        missing_cells: dict[str, list[str]] = {}
        for limb in self.limbs:
            for code, row in self.table(limb).iterrows():
                lacking = [
                    self.factor.words(level)
                    for level, value in zip(self.levels, row, strict=True)
                    if pd.isna(value)
                ]
                if lacking:
                    missing_cells.setdefault(str(code), []).append(
                        f"{limb} at {', '.join(lacking)}"
                    )
        lines = [
            f"{code} has no value for {'; '.join(cells)}" for code, cells in missing_cells.items()
        ]
        return shortened(lines)


def measures_of(material: Material, factor: Factor = LATENCY_FACTOR) -> Iterator[Measure]:
    """Yield the study's measures with values: scores, contact time, completions, joint errors."""
    for one in _measures_of(material, factor):
        yield replace(one, factor=factor)


def _measures_of(material: Material, factor: Factor) -> Iterator[Measure]:
    tested = completed(material)
    yield from _scores(tested, factor)
    tasks = tested.counting(tested.phases)
    tasks = tasks[tasks["phase_kind"].isin(COUNTED_KINDS)].astype({"completions": "float64"})
    yield from _measure(
        "contact_time",
        ("Contact time", "s"),
        "Active seconds per phase during which a side of a box was red, whichever body part "
        "touched it.",
        tasks.rename(columns={"side_red_s": "value"}),
        factor,
    )
    yield from _measure(
        "completions",
        ("Completed tasks", "tasks"),
        "Completed tasks per phase.",
        tasks.rename(columns={"completions": "value"}),
        factor,
    )
    errors = task_angles(tested.counting(tested.errors))
    yield from _measure(
        "joint_error",
        ("Joint error", "deg"),
        "Angle between the participant's pose and the body they saw, a mean over joints and the "
        "active time of a phase. It shows the effect of latency on the body, not on the person.",
        errors.rename(columns={"mean_deg": "value"}),
        factor,
    )
    yield from _measure(
        "joint_error_fingers",
        ("Joint error of the fingers", "deg"),
        "The same of the fingers, a mean over their joints: only phases in which fingers were "
        "recorded count. The joint error of the body leaves fingers out.",
        finger_angles(tested.counting(tested.errors)).rename(columns={"mean_deg": "value"}),
        factor,
    )


def completed(material: Material) -> Material:
    """Return the data of valid completed sessions; open sessions may still change."""
    sessions = material.sessions
    tested = (sessions["status"] == "completed") & sessions["valid"]
    return material.of_sessions(set(sessions[tested]["session_id"]))


def left_out(material: Material) -> list[str]:
    """Return the sessions that are in no test, each with the reason."""
    sessions = material.sessions
    out = sessions[(sessions["status"] != "completed") | ~sessions["valid"]]
    status_texts = {"planned": "not started", "active": "still open"}
    lines = [
        f"{code}: not valid ({why})"
        if status == "completed"
        else f"{code}: {status_texts.get(status, status)}"
        for code, status, why in zip(
            out["participant_code"], out["status"], out["reasons_not_valid"], strict=True
        )
    ]
    return shortened(lines)


def shortened(lines: Sequence[str]) -> list[str]:
    """Return the first lines and, if there are more, a line that says how many."""
    more = len(lines) - _SHOWN
    return [*lines[:_SHOWN], *([f"and {more} more"] if more > 0 else [])]


def _scores(tested: Material, factor: Factor) -> Iterator[Measure]:
    scores = tested.counting(tested.scores).dropna(subset=["limb", "value"])
    for key, own in scores.groupby("instrument"):
        newest = tested.instruments[str(key), int(own["instrument_version"].max())]
        for score in newest.scores:
            rows = own[own["score"] == score.key]
            if rows.empty or _is_rescaled(newest, score.key):
                continue
            title = score.label.get("en") or score.key
            about = f"Score of the questionnaire “{_title(newest)}”."
            limits = (score.minimum, score.maximum)
            yield from _measure(
                f"{key}_{score.key}",
                (title, "points"),
                f"{about} {_range_words(limits)}".strip(),
                rows,
                factor,
                continuous=False,
                maximum=_symmetric(limits),
                predicted="falls" if score.key in FALLS else None,
            )


def _title(instrument: Instrument) -> str:
    title: Mapping[str, str] = instrument.title
    return title.get("en") or instrument.key


def _is_rescaled(instrument: Instrument, score: str) -> bool:
    """Return whether a score is computed from one other score alone; rank tests of both agree."""
    names = names_in(instrument.formulas[score])
    return len(names) == 1 and names <= instrument.formulas.keys()


def _range_words(limits: tuple[float | None, float | None]) -> str:
    low, high = limits
    return "" if low is None or high is None else f"Possible values: {low:g} to {high:g}."


def _symmetric(limits: tuple[float | None, float | None]) -> float | None:
    low, high = limits
    return high if low is not None and high is not None and low == -high else None


def _measure(
    key: str,
    title_and_unit: tuple[str, str],
    about: str,
    rows: pd.DataFrame,
    factor: Factor,
    *,
    continuous: bool = True,
    maximum: float | None = None,
    predicted: Direction | None = None,
) -> Iterator[Measure]:
    complete = rows.dropna(subset=["value", "limb", factor.column, "block"])
    if complete.empty:
        return
    places = ["participant_code", "limb", factor.column, "block"]
    yield Measure(
        key=key,
        title=title_and_unit[0],
        unit=title_and_unit[1],
        about=about,
        values=per_participant(complete, "value", factor.column),
        places=complete.groupby(places)["value"].mean().reset_index(),
        continuous=continuous,
        maximum=maximum,
        predicted=predicted,
    )
