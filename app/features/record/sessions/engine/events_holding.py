"""Events of a session that a stop rule holds."""

from dataclasses import dataclass

from app.features.record.sessions.engine.event import Event


@dataclass(frozen=True, kw_only=True)
class StopRuleMet(Event):
    """A form met a stop rule of the study, by its index: the session is held from here."""

    type = "stop_rule_met"
    rule: int
    submission_id: str


@dataclass(frozen=True, kw_only=True)
class StopRuleOverridden(Event):
    """The operator goes on although a stop rule was met, for the reason given."""

    type = "stop_rule_overridden"
    content_id: str
    content_hash: str
