"""What a study declares before it looks: one primary test, and whom it leaves out.

Part of the study's content, so it is hashed, versioned and frozen with the rest: the hash that a
registry holds names this text and no other. Everything that is not declared is exploratory.
"""

from typing import Annotated, Literal, Self

from pydantic import Field, StringConstraints, model_validator

from app.protocol.common import Key, Strict, refusal

Measure = Literal["score", "contact_time", "completions"]
PrimaryTestName = Literal["friedman", "page_trend", "rm_anova", "against_reference"]
Direction = Literal["two_sided", "rises", "falls"]
RuleName = Literal[
    "complete_session",
    "minimum_frame_rate_hz",
    "minimum_share_of_frames",
    "maximum_latency_error_ms",
    "minimum_active_time_s",
    "maximum_straight_lined_forms",
]
DIRECTIONS: dict[str, tuple[str, ...]] = {
    "friedman": ("two_sided",),
    "rm_anova": ("two_sided",),
    "page_trend": ("rises", "falls"),
    "against_reference": ("two_sided", "rises", "falls"),
}
LIMITS: dict[str, tuple[float, float]] = {
    "minimum_frame_rate_hz": (1.0, 1000.0),
    "minimum_share_of_frames": (0.0, 1.0),
    "maximum_latency_error_ms": (0.0, 10_000.0),
    "minimum_active_time_s": (0.0, 86_400.0),
    "maximum_straight_lined_forms": (0.0, 100.0),
}
"""Lowest and highest sensible limit of each rule that has one."""


class PrimaryTest(Strict):
    """The one test that the study is about.

    `measure`: a score of an instrument that is asked after a task, contact time (s) or completions.
    `limb`: of which task; "both" is the mean of a participant's tasks. `factor` is the added
    latency. `direction`: of the measure as latency grows; "against_reference" compares each
    condition with `reference` by exact signed-rank tests, and `correction` adjusts for all of them.
    """

    measure: Measure
    instrument: Key | None = None
    score: Key | None = None
    limb: Literal["hand", "foot", "both"]
    factor: Literal["latency"] = "latency"
    test: PrimaryTestName
    direction: Direction = "two_sided"
    reference: Key | None = None
    correction: Literal["holm", "none"] = "none"

    @model_validator(mode="after")
    def _fits_together(self) -> Self:
        named = self.instrument is not None and self.score is not None
        if (self.measure == "score") != named or (self.instrument is None) != (self.score is None):
            raise refusal(
                "A score is named by its instrument and its key; other measures by neither.",
                value=self.measure,
                valid="instrument and score with the measure score, none of them otherwise",
                remedy="Add both, as in instrument: karas2020 and score: agency, or remove both.",
                at=("measure",),
            )
        if self.direction not in DIRECTIONS[self.test]:
            raise refusal(
                f"The test {self.test} cannot have the direction {self.direction}.",
                value=self.direction,
                valid=list(DIRECTIONS[self.test]),
                remedy=f"Use one of: {', '.join(DIRECTIONS[self.test])}.",
                at=("direction",),
            )
        several = self.test == "against_reference"
        if several != (self.reference is not None):
            raise refusal(
                "A reference condition belongs to the test against_reference, and to no other.",
                value=self.reference,
                valid="the key of a condition with against_reference, none otherwise",
                remedy="Name the condition that the others are compared with, or remove it.",
                at=("reference",),
            )
        if not several and self.correction != "none":
            raise refusal(
                f"The test {self.test} is one test: there is nothing to correct for.",
                value=self.correction,
                valid="none",
                remedy="Leave correction out.",
                at=("correction",),
            )
        return self


class ExclusionRule(Strict):
    """Whom the primary test leaves out: a session of which any task phase breaks the rule.

    complete_session: was not completed. minimum_frame_rate_hz, minimum_share_of_frames: of the
    avatar's recorded frames; the share is active time outside gaps. maximum_latency_error_ms:
    achieved against ordered latency. minimum_active_time_s: of a task phase.
    maximum_straight_lined_forms: forms of a session whose ratings are all alike.
    """

    rule: RuleName
    limit: float | None = None

    @model_validator(mode="after")
    def _has_its_limit(self) -> Self:
        low, high = LIMITS.get(self.rule, (None, None))
        if low is None or high is None:
            if self.limit is not None:
                raise refusal(
                    f"The rule {self.rule} has no limit.",
                    value=self.limit,
                    valid="no limit",
                    remedy="Leave limit out.",
                    at=("limit",),
                )
        elif self.limit is None or not low <= self.limit <= high:
            raise refusal(
                f"The rule {self.rule} needs a limit from {low:g} to {high:g}.",
                value=self.limit,
                valid=f"from {low:g} to {high:g}",
                remedy=f"Give a limit from {low:g} to {high:g}.",
                at=("limit",),
            )
        return self


class Preregistration(Strict):
    """What is declared. `planned_n`: participants in the primary test. `registration`: where it
    was registered, once it was.
    """

    alpha: Annotated[float, Field(gt=0, le=0.2, description="above 0, at most 0.2")]
    planned_n: Annotated[int, Field(ge=2, le=10_000, description="participants, 2 to 10000")]
    primary: PrimaryTest
    exclusions: Annotated[tuple[ExclusionRule, ...], Field(max_length=20)] = ()
    registration: Annotated[str, StringConstraints(max_length=300)] = ""

    @model_validator(mode="after")
    def _rules_once(self) -> Self:
        rules = [one.rule for one in self.exclusions]
        for at, rule in enumerate(rules):
            if rule in rules[:at]:
                raise refusal(
                    f"The rule {rule} is there twice.",
                    value=rule,
                    valid="every rule once",
                    remedy="Keep one of them.",
                    at=("exclusions", at, "rule"),
                )
        return self
