"""The attempts on one axis: what was found, what was objected to, and which gains are kept."""

from dataclasses import dataclass

from app.science.avatar.configuration import AxisSettings
from app.science.avatar.tuning.experiments import natural_hz
from app.science.avatar.tuning.heuristics import HEURISTICS, Gains
from app.science.avatar.tuning.relay import NoOscillation
from app.science.avatar.tuning.results import AxisTuning, Experiment, TuningOptions
from app.science.avatar.tuning.step_response import StepFigures, objection


@dataclass(frozen=True)
class _Attempt:
    experiment: Experiment
    gains: Gains
    overshoot_percent: float = 0.0
    objections: tuple[str, ...] = ()


class AxisAttempts:
    """One axis, and the one on the other side that gets the same gains.

    Attributes:
        gains: of the latest attempt; after `settle` the ones that are kept.
    """

    def __init__(self, axis: str, settings: AxisSettings, options: TuningOptions) -> None:
        self._axis, self._options = axis, options
        self._before = self.gains = Gains(settings.kp, settings.kd)
        self._attempts: list[_Attempt] = []
        self._count = 0
        self._failure: NoOscillation | None = None
        self._kept: _Attempt | None = None

    @property
    def accepted(self) -> bool:
        """Whether the latest attempt oscillated and nothing is said against its gains."""
        return self._failure is None and bool(self._attempts) and not self._attempts[-1].objections

    def take(self, found: Experiment | NoOscillation) -> None:
        """Take the outcome of an experiment."""
        self._count += 1
        if isinstance(found, NoOscillation):
            self._failure = found
            return
        self._failure = None
        rule = HEURISTICS[self._options.heuristic]
        self.gains = rule.gains(found.found, _slowed(self._axis, found))
        self._attempts.append(_Attempt(found, self.gains))

    def judge(self, name: str, step: StepFigures, clearance: float) -> None:
        """Judge the latest gains by the trial of this axis or of the other side's."""
        if self._failure is not None or not self._attempts:
            return
        latest = self._attempts[-1]
        said = self._objection(step, clearance)
        objections = latest.objections if said is None else (*latest.objections, f"{name}: {said}")
        worst = max(latest.overshoot_percent, step.overshoot_percent)
        self._attempts[-1] = _Attempt(latest.experiment, latest.gains, worst, objections)

    def settle(self) -> None:
        """Keep the best gains: with the fewest objections, then the least overshoot."""
        if self._attempts:
            self._kept = min(
                self._attempts, key=lambda one: (len(one.objections), one.overshoot_percent)
            )
            self.gains = self._kept.gains
        else:
            self.gains = self._before

    def result(self, name: str, step: StepFigures, clearance: float) -> AxisTuning:
        """What is reported of this axis, or of the other side's, after the last trial."""
        said = self._objection(step, clearance)
        if self._kept is None:
            reason = self._failure.reason if self._failure is not None else "it was not tried"
            status, note = f"flagged: {reason}", "the gains it had are kept"
        elif said is not None:
            status, note = f"flagged: {said}", "the best gains that were found"
        else:
            status = "tuned" if self._count == 1 else "retried"
            note = "" if self._count == 1 else f"accepted at attempt {self._count}"
        if name != self._axis:
            note = f"{note}, copied from {self._axis}" if note else f"copied from {self._axis}"
        return AxisTuning(
            name=name,
            kp=self.gains.kp,
            kd=self.gains.kd,
            status=status,
            note=note,
            attempts=self._count,
            experiment=None if self._kept is None else self._kept.experiment,
            mirrored_from=None if name == self._axis else self._axis,
            step=step,
        )

    def _objection(self, step: StepFigures, clearance: float) -> str | None:
        accepted = self._options.accepted_overshoot_percent
        return objection(step, clearance, accepted_overshoot_percent=accepted)


def _slowed(axis: str, found: Experiment) -> float:
    """The frequency for rules by inertia: the one this attempt aims at."""
    return min(found.aimed_hz, natural_hz(axis))
