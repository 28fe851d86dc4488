"""Gains that are there already, tried as a tuning would try its own: nothing is changed."""

from collections.abc import Callable
from dataclasses import dataclass, field

from app.science.avatar.body import Figure
from app.science.avatar.configuration import Configuration
from app.science.avatar.mjcf import avatar_model
from app.science.avatar.tuning.crew import Crew
from app.science.avatar.tuning.evaluation import Trial
from app.science.avatar.tuning.plant import bare
from app.science.avatar.tuning.results import AxisTuning, TuningOptions, TuningProgress
from app.science.avatar.tuning.step_response import objection


@dataclass(frozen=True)
class Assessment:
    """What the gains of a configuration do.

    Attributes:
        configuration: as it was given.
        stature_m: of the body it was tried on.
        axes: every axis, in its order; `accepted`, `locked`, or `flagged: ` and why.
        wall_s: how long it took by the clock that was given.
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
    figure: Figure | None = None,
    wall_s: Callable[[], float],
    progress: Callable[[TuningProgress], None] = lambda _: None,
    cancelled: Callable[[], bool] = lambda: False,
) -> Assessment:
    """Let each free axis jump on the whole body, with the gains it has.

    Args:
        configuration: its gains, mass, locks, limits and greatest torques are taken.
        stature_m: of the body.
        options: of these the accepted overshoot and the workers.
        figure, wall_s, progress, cancelled: as for `tune`.

    Raises:
        BodyError: there is no such body.
        TuningCancelled: `cancelled` said so.
    """
    chosen = TuningOptions() if options is None else options
    started_s = wall_s()
    built = avatar_model(configuration, stature_m, figure=figure)
    in_force = configuration.in_force
    free = [name for name in in_force if name not in configuration.locked_axes]
    steps = {}
    trial = Trial(bare(built.body), built.masses, in_force, gravity=configuration.gravity)
    if free:
        steps = Crew(chosen.workers, progress, cancelled).each(1, "steps", free, trial.step)

    def told(name: str) -> AxisTuning:
        own, step = configuration.axes[name], steps.get(name)
        if step is None:
            return AxisTuning(name, own.kp, own.kd, "locked")
        said = objection(
            step,
            trial.clearance(name),
            accepted_overshoot_percent=chosen.accepted_overshoot_percent,
        )
        status = "accepted" if said is None else f"flagged: {said}"
        return AxisTuning(name, own.kp, own.kd, status, step=step)

    axes = tuple(told(name) for name in configuration.axes)
    return Assessment(configuration, stature_m, axes, wall_s() - started_s)
