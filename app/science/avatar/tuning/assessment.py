"""Assess the gains of a configuration by the tests of a tuning, without changing them."""

from collections.abc import Callable
from dataclasses import dataclass, field

from app.science.avatar.body import Figure
from app.science.avatar.configuration import Configuration
from app.science.avatar.mjcf import avatar_model
from app.science.avatar.tuning.axis_pool import AxisPool
from app.science.avatar.tuning.evaluation import Trial
from app.science.avatar.tuning.plant import without_shapes
from app.science.avatar.tuning.results import AxisTuning, TuningOptions, TuningProgress
from app.science.avatar.tuning.step_response import objection


@dataclass(frozen=True)
class Assessment:
    """The result of testing the gains of a configuration.

    Attributes:
        configuration: the configuration as it was given.
        stature_m: the stature of the body that was tested.
        axes: every axis, in the configuration's order; its status is `accepted`, `locked`, or
            `flagged: ` and the reason.
        wall_s: elapsed time by the given clock.
    """

    configuration: Configuration
    stature_m: float
    axes: tuple[AxisTuning, ...] = field(repr=False)
    wall_s: float


def assess(
    configuration: Configuration,
    stature_m: float,
    options: TuningOptions | None = None,
    *,
    wall_s: Callable[[], float],
    progress: Callable[[TuningProgress], None] = lambda _: None,
    cancelled: Callable[[], bool] = lambda: False,
    figure: Figure | None = None,
) -> Assessment:
    """Test the gains of each free axis by a step of its target on the whole body.

    Args:
        configuration: supplies gains, mass, locks, limits and torque limits.
        stature_m: the stature of the body.
        options: only the accepted overshoot and the number of workers are used.
        figure, wall_s, progress, cancelled: the same as for `tune`.

    Raises:
        BodyError: the body cannot be built.
        TuningCancelled: `cancelled` returned true.
    """
    chosen = TuningOptions() if options is None else options
    started_s = wall_s()
    built = avatar_model(configuration, stature_m, figure=figure)
    in_force = configuration.in_force
    free = [name for name in in_force if name not in configuration.locked_axes]
    steps = {}
    trial = Trial(without_shapes(built.body), built.masses, in_force, gravity=configuration.gravity)
    if free:
        steps = AxisPool(chosen.workers, progress, cancelled).run(1, "steps", free, trial.step)

    def tuning_of(name: str) -> AxisTuning:
        own, step = configuration.axes[name], steps.get(name)
        if step is None:
            return AxisTuning(name, own.kp, own.kd, "locked")
        problem = objection(
            step,
            trial.clearance(name),
            accepted_overshoot_percent=chosen.accepted_overshoot_percent,
        )
        status = "accepted" if problem is None else f"flagged: {problem}"
        return AxisTuning(name, own.kp, own.kd, status, step=step)

    axes = tuple(tuning_of(name) for name in configuration.axes)
    return Assessment(configuration, stature_m, axes, wall_s() - started_s)
