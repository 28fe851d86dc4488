"""Read scene files (YAML or JSON): a floor with obstacles, places and the paths between them.

    key: my-lab
    bounds_m: [-2, -2, 2, 4]          # left, near, right, far; x to the right, y ahead
    clearance_m: 0.2                  # a walker's smallest distance from obstacles
    obstacles:
      - {shape: box, name: table, center_m: [0, 1], size_m: [1.2, 0.6], turned_deg: 10}
      - {shape: disc, name: pole, center_m: [1, 2], radius_m: 0.05}
      - {shape: wall, name: screen, from_m: [-2, 0], to_m: [-1, 0], thickness_m: 0.05}
      - {shape: polygon, name: corner, corners_m: [[1, -2], [2, -2], [2, -1]]}
    places: {start: [0, -1], goal: [0, 3]}
    paths:
      - {name: there, from: start, to: goal}

All problems of a file are reported together, each with line, column and remedy.
"""

import json
from pathlib import Path as FilePath

from pydantic import ValidationError

from app.adapters.walks.scene_schema import SceneFile, point_of
from app.protocol import ConfigError, ConfigProblem, Path, Source, explain, path_text, read_source
from app.science.walking.scene import Obstacle, Scene, SceneError, ScenePath

SHIPPED = FilePath(__file__).with_name("scenes")
"""The workplaces of the paper, as scene files."""
_REMEDY = "Correct it: lengths are in metres, x to the right, y ahead."


def shipped_scenes() -> dict[str, FilePath]:
    """Return the shipped scene files, by their scenes' keys."""
    return {file.stem: file for file in sorted(SHIPPED.glob("*.yaml"))}


def load_shipped(key: str) -> Scene:
    """Read a shipped scene; raise KeyError for an unknown key."""
    return load_scene(shipped_scenes()[key].read_text(encoding="utf-8"))


def load_scene(text: str) -> Scene:
    """Parse a scene file.

    Raises:
        ConfigError: the file is invalid; the error lists every problem: unknown keys, values that
            are not numbers, an outline that is not convex, a place inside an obstacle, a path to an
            unknown place.
    """
    source = read_source(text)
    if not isinstance(source.tree, dict):
        remedy = "Begin with lines like key: my-lab."
        problem = ConfigProblem("", 1, 1, "The file is not a mapping.", remedy=remedy)
        raise ConfigError([*source.problems, problem])
    try:
        # Validated as JSON, so that lists may become tuples but nothing else is converted.
        file = SceneFile.model_validate_json(json.dumps(source.tree))
    except ValidationError as error:
        found = explain(error, SceneFile.model_json_schema(), source)
        raise ConfigError([*source.problems, *found]) from error
    problems = list(source.problems)
    scene = _scene(file, source, problems)
    if scene is None or problems:
        raise ConfigError(problems)
    return scene


def _scene(file: SceneFile, source: Source, problems: list[ConfigProblem]) -> Scene | None:
    """Build the scene, recording each SceneError with its place in the file."""
    obstacles: list[Obstacle] = []
    for at, shape in enumerate(file.obstacles):
        try:
            obstacles.append(shape.obstacle())
        except SceneError as error:
            problems.append(_at(("obstacles", at), error, source))
    try:
        floor = Scene(file.key, file.bounds_m, tuple(obstacles), {}, (), file.clearance_m)
    except SceneError as error:
        problems.append(_at(("bounds_m",), error, source))
        return None
    places = {name: point_of(place) for name, place in file.places.items()}
    for name, point in places.items():
        try:
            floor.check_point(point, f"Place {name!r}")
        except SceneError as error:
            problems.append(_at(("places", name), error, source))
    paths = tuple(ScenePath(way.name, way.start, way.goal) for way in file.paths)
    for at, path in enumerate(paths):
        unknown = [place for place in (path.start, path.goal) if place not in places]
        if unknown or path.start == path.goal:
            problem = f"names {unknown[0]!r}" if unknown else "ends where it begins"
            valid = ", ".join(places) or "none"
            refused = SceneError(f"Path {path.name!r} {problem}; places are {valid}.")
            problems.append(_at(("paths", at), refused, source))
    if problems:
        return None
    named = (file.key, file.bounds_m, tuple(obstacles), places, paths)
    return Scene(*named, file.clearance_m, file.title, file.about)


def _at(path: Path, error: SceneError, source: Source) -> ConfigProblem:
    mark = source.place(path)
    return ConfigProblem(path_text(path), mark.line, mark.column, str(error), remedy=_REMEDY)
