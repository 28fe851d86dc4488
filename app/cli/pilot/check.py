"""Run `reembody pilot check`: find what would break a study, before anybody takes part.

The file itself is validated first, as everywhere; the rest needs a body or a number of participants
(`app.features.results.pilot.simulation.check`).
"""

from collections.abc import Callable, Iterator
from dataclasses import asdict
from pathlib import Path
from typing import Any

from app.cli.pilot.inputs import read_study
from app.cli.pilot.output import told
from app.features.results.pilot.simulation import Checked, Finding, check_study


def carry_out_check(name: str, scene: str | None, now: Callable[[str], None]) -> Checked:
    """Check a study, and the scene of its walks if one is given, by its file or a shipped key.

    Raises ValueError with every problem of an invalid file, OSError.
    """
    file = read_study(name)
    of_scene = [] if scene is None else list(_paths(scene))
    return check_study(file, told(file.study.protocol.key, now), of_scene)


def check_json(checked: Checked) -> dict[str, Any]:
    """Return the result for scripts."""
    return {
        "simulated": True,
        "study": checked.study,
        "sha256": checked.sha256,
        "problems": [asdict(one) for one in checked.findings],
        "reach": [asdict(one) for one in checked.reached],
    }


def check_text(checked: Checked) -> str:
    """Describe the result, problems first."""
    lines = [
        f"SIMULATED: {checked.study}, problems: {len(checked.findings)}",
    ]
    for one in checked.findings:
        lines += [f"  {one.path}: {one.message}", f"    {one.remedy}"]
    lines += ["", "The first task of a slow person who never misses, at the longest latency:"]
    lines += [
        f"  {one.limb:4}  {one.hand:5}  {one.stature_m:.3f} m  {one.latency_ms:5.0f} ms  "
        + (
            f"{one.completion_s:5.1f} s"
            if one.completion_s is not None
            else f"out of reach: {', '.join(one.out_of_reach)}"
        )
        for one in checked.reached
    ]
    lines += [
        "Statures: the 5th percentile of women and the 95th of men (Huston 2009); pace and",
        "reactions: assumed. Edges of boxes stop nobody here. So the check finds what cannot be",
        "reached or has no time; whether people complete tasks, a cohort says (pilot STUDY).",
    ]
    return "\n".join(lines)


def _paths(name: str) -> Iterator[Finding]:
    """Yield the walks of a scene for which the planner of the walking model finds no path."""
    # The planner loads the compiler, which no other check needs.
    from app.cli.walk.scenes import read_scene
    from app.science.walking.planning import LazyThetaPlanner
    from app.science.walking.scene import SceneError

    scene = read_scene(name)
    if scene is None:
        return
    called = Path(name).name
    planner = LazyThetaPlanner(scene)
    for at, walk in enumerate(scene.paths):
        try:
            planner.plan(scene.places[walk.start], scene.places[walk.goal])
        except SceneError as error:
            yield Finding(
                "scene_without_path",
                f"{called}: paths[{at}]",
                f"Nobody can walk {walk.name!r} from {walk.start!r} to {walk.goal!r}: {error}",
                f"Move the places or obstacles, or ask for less than {scene.clearance_m:g} m of "
                "clearance_m.",
            )
    if not scene.paths:
        yield Finding(
            "scene_without_path",
            f"{called}: paths",
            "The scene asks for no walk at all.",
            "List under paths the walks that people are asked to do, each from a place to a place.",
        )
