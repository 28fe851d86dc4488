"""What a pre-flight check is: a key, words in both languages, what it can find, and how it looks.

The status belongs to the finding: "the tablet is not paired" is a failure whenever it is found, and
says what to do. A check only names the finding and the figures that go with it.
"""

from collections.abc import Awaitable, Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

from sqlalchemy.orm import Session

from app.models import StudySession
from app.platform.context import AppContext
from app.texts import Words

Expected = Literal["at_least", "at_most"]
Unit = Literal["s", "ms", "Hz", "GB", "joints", "phases", "instruments", "texts"]


@dataclass(frozen=True)
class Finding:
    """One thing that a check can find.

    Attributes:
        key: unique within its check; check and finding together are the code, as in "disk.low".
        status: "wait" where it cannot be judged yet and will be without anybody's doing.
        words: `{{value}}` and `{{limit}}` are filled with what was measured.
        remedy: what to do about it; failures have one, nothing else has.
    """

    key: str
    status: Literal["ok", "wait", "fail"]
    words: Words
    remedy: Words | None = None

    def __post_init__(self) -> None:
        if (self.status == "fail") != (self.remedy is not None):
            raise ValueError(
                f"The finding {self.key!r} has the status {self.status!r} and the remedy "
                f"{self.remedy!r}; a failure says what to do, and nothing else does."
            )


@dataclass(frozen=True)
class Found:
    """What a check has found this time.

    Attributes:
        finding: key of one of the check's findings.
        value, unit: what was measured.
        expected, limit: what the value must keep to, in the same unit.
        details: names and hashes, in no language.
    """

    finding: str
    value: float | None = None
    unit: Unit | None = None
    expected: Expected | None = None
    limit: float | None = None
    details: tuple[str, ...] = ()


@dataclass(frozen=True)
class Situation:
    """Where a check looks: the session, the database (for reading), and the running server.

    `signal`: figures of the headset's live watch; empty while none is connected.
    """

    session: StudySession
    db: Session
    context: AppContext
    signal: Mapping[str, Any] = field(default_factory=dict)

    @property
    def headset_connected(self) -> bool:
        """Whether the session's headset is connected now."""
        return self.context.hub.headset_connected(self.session.id)


@dataclass(frozen=True)
class PreflightCheck:
    """One line of the list.

    Attributes:
        key: also in events and overrides, so it is never renamed.
        title: what is checked.
        findings: in the order of the interface's codes.
        mended_in_seconds: whether somebody at hand can put it right at once, as by waking the
            tablet; the page looks at such a check more often.
    """

    key: str
    title: Words
    findings: tuple[Finding, ...]
    mended_in_seconds: bool = field(default=False, kw_only=True)

    def finding(self, key: str) -> Finding:
        """One of the findings; raises KeyError where the check has none of that key."""
        return {one.key: one for one in self.findings}[key]

    def code(self, finding: str) -> str:
        """The finding's name in the interface and on record."""
        return f"{self.key}.{finding}"

    @property
    def codes(self) -> tuple[str, ...]:
        """Of all findings."""
        return tuple(self.code(one.key) for one in self.findings)

    def texts(self) -> dict[str, Words]:
        """Every text of this check by its key in the tables of the pages."""
        texts = {f"preflight.check.{self.key}": self.title}
        for one in self.findings:
            texts[f"preflight.found.{self.code(one.key)}"] = one.words
        for one in self.findings:
            if one.remedy is not None:
                texts[f"preflight.todo.{self.code(one.key)}"] = one.remedy
        return texts


@dataclass(frozen=True)
class StateCheck(PreflightCheck):
    """A check that reads: `look` gets one reading transaction, shared with the other checks."""

    look: Callable[[Situation], Found]


@dataclass(frozen=True)
class TrialCheck(PreflightCheck):
    """A check that tries something out: `attempt` opens the transactions that it needs itself.

    It gets the session's id, since no transaction is open when it is called.
    """

    attempt: Callable[[AppContext, str], Awaitable[Found]]
