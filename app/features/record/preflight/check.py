"""The definition of a pre-flight check: key, texts in both languages, findings, and function.

The status belongs to the finding: "the tablet is not paired" is always a failure and says what to
do. A check returns only the key of its finding and the figures that go with it.
"""

from collections.abc import Awaitable, Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

from sqlalchemy.orm import Session

from app.models import StudySession
from app.platform.context import AppContext
from app.texts import Words

Expected = Literal["at_least", "at_most"]
FoundStatus = Literal["ok", "unneeded", "wait", "fail"]
Unit = Literal["s", "ms", "mm", "Hz", "GB", "joints", "phases", "instruments", "texts"]


@dataclass(frozen=True)
class Finding:
    """One of the possible findings of a check.

    Attributes:
        key: unique within its check; check and finding together form the code, as in "disk.low".
        status: "wait" if it cannot be judged yet, but will be later without any action;
            "unneeded" if the session uses nothing of what is checked.
        words: `{{value}}` and `{{limit}}` are replaced by what was measured.
        remedy: what to do about it; required for failures, and absent otherwise.
    """

    key: str
    status: FoundStatus
    words: Words
    remedy: Words | None = None

    def __post_init__(self) -> None:
        if (self.status == "fail") != (self.remedy is not None):
            raise ValueError(
                f"The finding {self.key!r} has the status {self.status!r} and the remedy "
                f"{self.remedy!r}; failures must have a remedy, and other findings must not."
            )


@dataclass(frozen=True)
class Found:
    """The result of running a check once.

    Attributes:
        finding: key of one of the check's findings.
        value, unit: what was measured.
        expected, limit: how the value must compare with the limit, in the same unit.
        details: names and hashes, which are not translated.
    """

    finding: str
    value: float | None = None
    unit: Unit | None = None
    expected: Expected | None = None
    limit: float | None = None
    details: tuple[str, ...] = ()


@dataclass(frozen=True)
class Situation:
    """The input of a check: the session, the database (read-only), and the running server.

    `signal`: figures of the headset's live watch; empty while no headset is connected.
    """

    session: StudySession
    db: Session
    context: AppContext
    signal: Mapping[str, Any] = field(default_factory=dict)

    @property
    def headset_connected(self) -> bool:
        """Return whether the session's headset is currently connected."""
        return self.context.hub.headset_connected(self.session.id)


@dataclass(frozen=True)
class PreflightCheck:
    """A check of the pre-flight list.

    Attributes:
        key: also stored in events and overrides, so it is never renamed.
        title: what is checked.
        findings: in the order of the interface's codes.
        mended_in_seconds: whether somebody nearby can fix the problem immediately, for example by
            waking the tablet; the page repeats such a check more often.
    """

    key: str
    title: Words
    findings: tuple[Finding, ...]
    mended_in_seconds: bool = field(default=False, kw_only=True)

    def finding(self, key: str) -> Finding:
        """Return the finding with this key; raises KeyError if the check has none."""
        return {one.key: one for one in self.findings}[key]

    def code(self, finding: str) -> str:
        """Return the code of a finding, as used in the interface and in the record."""
        return f"{self.key}.{finding}"

    @property
    def codes(self) -> tuple[str, ...]:
        """Return the codes of all findings."""
        return tuple(self.code(one.key) for one in self.findings)

    def texts(self) -> dict[str, Words]:
        """Return every text of this check by its key in the pages' text tables."""
        texts = {f"preflight.check.{self.key}": self.title}
        for one in self.findings:
            texts[f"preflight.found.{self.code(one.key)}"] = one.words
        for one in self.findings:
            if one.remedy is not None:
                texts[f"preflight.todo.{self.code(one.key)}"] = one.remedy
        return texts


@dataclass(frozen=True)
class StateCheck(PreflightCheck):
    """A check that only reads: `run` is given a read transaction shared with the other checks."""

    run: Callable[[Situation], Found]


@dataclass(frozen=True)
class TrialCheck(PreflightCheck):
    """A check that tries something: `attempt` opens the transactions it needs itself.

    It is given the session's id, since no transaction is open when it is called.
    """

    attempt: Callable[[AppContext, str], Awaitable[Found]]
