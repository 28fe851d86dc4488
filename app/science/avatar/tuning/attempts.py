"""Record the tuning attempts of one axis and choose the gains to keep."""

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
    """The tuning attempts of one axis, whose gains its mirrored axis may share.

    Attributes:
        gains: the gains of the latest attempt; after `settle`, the best ones.
    """

    def __init__(self, axis: str, settings: AxisSettings, options: TuningOptions) -> None:
        self._axis, self._options = axis, options
        self._initial = self.gains = Gains(settings.kp, settings.kd)
        self._attempts: list[_Attempt] = []
        self._count = 0
        self._failure: NoOscillation | None = None
        self._best: _Attempt | None = None

    @property
    def accepted(self) -> bool:
        """Return whether the latest attempt oscillated and its gains met no objection."""
        return self._failure is None and bool(self._attempts) and not self._attempts[-1].objections

    def record(self, outcome: Experiment | NoOscillation) -> None:
        """Record the outcome of an experiment and compute gains from it."""
        self._count += 1
        if isinstance(outcome, NoOscillation):
            self._failure = outcome
            return
        self._failure = None
        self.gains = gains_of(self._axis, outcome, self._options)
        self._attempts.append(_Attempt(outcome, self.gains))

    def judge(self, name: str, step: StepFigures, clearance: float) -> None:
        """Judge the latest gains by the step response of this axis or of its mirrored axis."""
        if self._failure is not None or not self._attempts:
            return
        latest = self._attempts[-1]
        problem = self._objection(step, clearance)
        added = () if problem is None else (f"{name}: {problem}",)
        worst = max(latest.overshoot_percent, step.overshoot_percent)
        self._attempts[-1] = _Attempt(
            latest.experiment, latest.gains, worst, latest.objections + added
        )

    def settle(self) -> None:
        """Choose the best gains: those with the fewest objections, then the least overshoot."""
        if self._attempts:
            self._best = min(
                self._attempts, key=lambda one: (len(one.objections), one.overshoot_percent)
            )
            self.gains = self._best.gains
        else:
            self.gains = self._initial

    def result(self, name: str, step: StepFigures, clearance: float) -> AxisTuning:
        """Return the result of this axis, or of its mirrored axis, after the last step response."""
        problem = self._objection(step, clearance)
        if self._best is None:
            reason = self._failure.reason if self._failure is not None else "it was not measured"
            status, note = f"flagged: {reason}", "its previous gains are kept"
        elif problem is not None:
            status, note = f"flagged: {problem}", "these are the best gains found"
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
            experiment=None if self._best is None else self._best.experiment,
            mirrored_from=None if name == self._axis else self._axis,
            step=step,
        )

    def _objection(self, step: StepFigures, clearance: float) -> str | None:
        accepted = self._options.accepted_overshoot_percent
        return objection(step, clearance, accepted_overshoot_percent=accepted)


def gains_of(axis: str, outcome: Experiment, options: TuningOptions) -> Gains:
    """Return the gains that the chosen rule gives for an experiment on an axis."""
    return HEURISTICS[options.heuristic].gains(outcome.found, _aimed_hz(axis, outcome))


def _aimed_hz(axis: str, outcome: Experiment) -> float:
    """Return the natural frequency that this attempt aimed at, for rules that use the inertia."""
    return min(outcome.aimed_hz, natural_hz(axis))
