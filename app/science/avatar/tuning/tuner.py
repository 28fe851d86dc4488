"""Tune a whole avatar: measure each axis, compute gains, test them, and retry or flag what fails.

1. A growing torque finds out how hard each free axis is to move (`ramp`), and a relay of that
   torque makes it oscillate, with all others rigid (`experiments`).
2. A rule computes gains from the oscillation (`heuristics`).
3. The whole body gets all the gains, and the step response of each axis is tested (`evaluation`).
4. Axes with an objection (`objection`) are retried with a weaker relay, which means lower gains.
   After the last attempt the best gains are kept and the axis is flagged with the reason.
5. If anything changed since an axis was tested, the whole body is tested once more.
6. An axis whose torque the user chose is also tuned by the ramp, once, and tested with these gains,
   for comparison only (`chosen`): the torque decides how stiff an axis becomes.

Torque limits and joint limits stay unchanged. With `mirror` only the left side is measured; both
sides are tested. An axis whose left counterpart is locked, missing or not chosen is tuned itself.

Axes that the options do not choose are neither measured nor tested and keep their gains; they
drive the body in the tests of the others.
"""

from collections.abc import Callable, Mapping
from dataclasses import replace

from app.science.avatar.body import Figure, mirrored_name
from app.science.avatar.configuration import AxisSettings, Configuration
from app.science.avatar.mjcf import avatar_model
from app.science.avatar.tuning.attempts import AxisAttempts, gains_of
from app.science.avatar.tuning.axis_pool import AxisPool
from app.science.avatar.tuning.chosen import ByRamp, with_choice
from app.science.avatar.tuning.evaluation import Trial
from app.science.avatar.tuning.experiments import laboratory
from app.science.avatar.tuning.ramp import MOTOR_SHARE
from app.science.avatar.tuning.relay import NoOscillation
from app.science.avatar.tuning.results import (
    AxisTuning,
    TuningError,
    TuningJournal,
    TuningOptions,
    TuningProgress,
    TuningReport,
)
from app.science.avatar.tuning.step_response import StepFigures


def tune(
    configuration: Configuration,
    stature_m: float,
    options: TuningOptions | None = None,
    *,
    figure: Figure | None = None,
    wall_s: Callable[[], float],
    progress: Callable[[TuningProgress], None] = lambda _: None,
    cancelled: Callable[[], bool] = lambda: False,
    journal: TuningJournal | None = None,
) -> TuningReport:
    """Find gains for every chosen free axis; the same input gives the same gains.

    Args:
        configuration: supplies mass, locks, limits and torque limits; axes that are locked or do
            not oscillate keep its gains.
        stature_m: the stature of the body.
        options: the options of the tuning; None for the defaults.
        figure: the model that the configuration names; it has all parts of the configuration.
        wall_s: a monotonic clock in seconds, such as `time.monotonic`.
        progress: function that is called after each axis.
        cancelled: function that is called repeatedly and returns whether to stop.
        journal: keeps the results; a tuning that was interrupted goes on from them, with the same
            gains in the end as one that was not.

    Raises:
        BodyError: the body cannot be built.
        TuningError: no chosen axis is free, a relay torque is given for an axis that is not
            measured, or one for all axes is more than any may take.
        TuningCancelled: `cancelled` returned true.
    """
    chosen = TuningOptions() if options is None else options
    pool = AxisPool(chosen.workers, progress, cancelled, journal)
    tuning = _Tuning(configuration, stature_m, figure, chosen, wall_s, pool, cancelled)
    started_s = wall_s()
    tuning.run()
    axes = tuning.results()
    gains = {one.name: one for one in axes}
    tuned = {
        name: replace(own, kp=gains[name].kp, kd=gains[name].kd)
        for name, own in configuration.axes.items()
    }
    return TuningReport(
        configuration=replace(configuration, axes=tuned),
        stature_m=stature_m,
        options=chosen,
        axes=axes,
        wall_s=wall_s() - started_s,
    )


class _Tuning:
    def __init__(
        self,
        configuration: Configuration,
        stature_m: float,
        figure: Figure | None,
        options: TuningOptions,
        wall_s: Callable[[], float],
        pool: AxisPool,
        cancelled: Callable[[], bool],
    ) -> None:
        self._configuration, self._options = configuration, options
        self._locked = configuration.locked_axes
        built = avatar_model(configuration, stature_m, figure=figure)
        in_force = configuration.in_force
        self._laboratory = laboratory(
            built.body, built.masses, in_force, options, wall_s=wall_s, cancelled=cancelled
        )
        self._pool = pool
        self._free = tuple(
            name for name in in_force if name not in self._locked and options.includes(name)
        )
        if options.axes is not None and not self._free:
            raise TuningError(
                f"none of the chosen axes can be tuned: {', '.join(options.axes)} are locked or"
                " missing in this configuration"
            )
        self._attempts = {
            name: AxisAttempts(name, in_force[name], options)
            for name in self._free
            if self._source(name) == name
        }
        for name in options.relay_torques_nm:
            if name not in self._attempts:
                raise TuningError(
                    f"a relay torque is given for {name}, which is not measured: it is locked, not"
                    " chosen, or copied from the other side; measured are"
                    f" {', '.join(self._attempts)}"
                )
        self._check_torques(in_force)
        self._trials: dict[str, StepFigures] = {}
        self._clearances: dict[str, float] = {}
        self._by_ramp: dict[str, ByRamp] = {}

    def _check_torques(self, settings: Mapping[str, AxisSettings]) -> None:
        """Raise TuningError for a torque for all axes that none of them may take."""
        most = {name: MOTOR_SHARE * settings[name].max_torque_nm for name in self._attempts}
        torque_nm = self._options.relay_torque_nm
        if torque_nm is None or not most or torque_nm <= max(most.values()):
            return
        strongest = max(most, key=lambda name: most[name])
        raise TuningError(
            f"a relay torque is {torque_nm:g} N m, which no axis may take: above 0 up to"
            f" {most[strongest]:g} N m is valid for the strongest, {strongest}, {MOTOR_SHARE:.0%}"
            " of its torque limit"
        )

    def run(self) -> None:
        """Run attempt after attempt, and finally test the whole body if anything changed since."""
        pending = tuple(self._attempts)
        last_attempt = 0
        for attempt in range(1, self._options.attempts + 1):
            self._experiment(attempt, pending)
            affected = [name for name in self._free if self._source(name) in pending]
            self._try(attempt, affected)
            for name in affected:
                self._attempts[self._source(name)].judge(
                    name, self._trials[name], self._clearances[name]
                )
            last_attempt = attempt
            pending = tuple(name for name in pending if not self._attempts[name].accepted)
            if not pending:
                break
        for one in self._attempts.values():
            one.settle()
        if last_attempt > 1 or pending:
            self._try(last_attempt, self._free)
        self._compare_with_ramp()

    def results(self) -> tuple[AxisTuning, ...]:
        """Return the result of every axis, in the configuration's order."""
        return tuple(self._result(name) for name in self._configuration.axes)

    def _source(self, name: str) -> str:
        """Return the axis whose gains this one gets.

        It is the axis itself, or its left counterpart where gains are mirrored.
        """
        other = mirrored_name(name)
        mirrors = self._options.mirror and name.startswith("Right") and other in self._free
        return other if mirrors else name

    def _experiment(self, attempt: int, axes: tuple[str, ...]) -> None:
        found = self._pool.run(
            attempt, "relay", axes, lambda axis: self._laboratory.experiment(axis, attempt)
        )
        for name, experiment in found.items():
            self._attempts[name].record(experiment)

    def _compare_with_ramp(self) -> None:
        """Tune and test by the ramp the axes whose torque was chosen, without keeping the gains."""
        chosen = tuple(
            name for name in self._attempts if self._options.relay_torque_of(name) is not None
        )
        if not chosen:
            return
        by_ramp = replace(self._laboratory, options=self._options.without_torques())
        found = self._pool.run(1, "relay", chosen, lambda axis: by_ramp.experiment(axis, 1))
        gains = {
            name: gains_of(name, outcome, self._options)
            for name, outcome in found.items()
            if not isinstance(outcome, NoOscillation)
        }
        affected = [name for name in self._free if self._source(name) in gains]
        settings = self._settings()
        for name in affected:
            own = gains[self._source(name)]
            settings[name] = replace(settings[name], kp=own.kp, kd=own.kd)
        lab = self._laboratory
        trial = Trial(lab.body, lab.masses, settings, gravity=self._configuration.gravity)
        steps = self._pool.run(1, "steps", affected, trial.step)
        self._by_ramp = {name: ByRamp(settings[name].kp, steps[name]) for name in affected}

    def _try(self, attempt: int, axes: tuple[str, ...] | list[str]) -> None:
        if not axes:
            return
        lab = self._laboratory
        trial = Trial(lab.body, lab.masses, self._settings(), gravity=self._configuration.gravity)
        self._trials.update(self._pool.run(attempt, "steps", axes, trial.step))
        self._clearances.update({name: trial.clearance(name) for name in axes})

    def _settings(self) -> dict[str, AxisSettings]:
        settings = dict(self._laboratory.settings)
        for name in self._free:
            gains = self._attempts[self._source(name)].gains
            settings[name] = replace(settings[name], kp=gains.kp, kd=gains.kd)
        return settings

    def _result(self, name: str) -> AxisTuning:
        own = self._configuration.axes[name]
        if name in self._locked:
            why = "its limits leave no range" if own.locked else "it is in a locked group"
            return AxisTuning(name, own.kp, own.kd, "locked", f"skipped: {why}")
        if name not in self._free:
            return AxisTuning(name, own.kp, own.kd, "kept", "not chosen")
        source = self._source(name)
        found = self._attempts[source].result(name, self._trials[name], self._clearances[name])
        return with_choice(found, self._by_ramp.get(name))
