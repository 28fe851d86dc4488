"""Find the scenes that files of `reembody walk` name: shipped ones by key, others by path."""

from pathlib import Path

from app.adapters.walks import load_scene, load_shipped, shipped_scenes
from app.errors import as_sentences, missing_file
from app.protocol import ConfigError
from app.science.walking.planning import WalkedScenes
from app.science.walking.records import OPEN_FLOOR
from app.science.walking.scene import Scene


def read_scene(key: str | None) -> Scene | None:
    """Read a shipped scene by its key, or a scene file; None stands for open floor.

    Raises:
        ValueError: the file is not a valid scene; lists all its problems, each with its line.
        OSError: it cannot be opened.
    """
    if key is None:
        return None
    if key in shipped_scenes():
        return load_shipped(key)
    path = Path(key)
    if not path.exists():
        shipped = ", ".join(shipped_scenes())
        raise ValueError(f"--scene: {missing_file(path)}; shipped with the product are {shipped}.")
    return _read_file(path)


class NamedScenes:
    """The scenes that options and files name.

    A name is the key of a scene that the product ships or that was named before, a scene file's
    path, relative to the file that names it, or `open floor`.
    """

    def __init__(self, usual: str | None) -> None:
        """Begin with the scene of recordings that name none; raise as `read_scene` does."""
        self.scenes: dict[str, Scene] = {}
        self._files: dict[Path, str] = {}
        self.usual: str | None = None
        if usual is not None and usual != OPEN_FLOOR:
            scene = read_scene(usual)
            if scene is not None:
                if usual not in shipped_scenes():
                    _require_other_key(scene, Path(usual), f"--scene {usual}")
                self.usual = self._add(scene, f"--scene {usual}")
                if usual not in shipped_scenes():
                    self._files[Path(usual).resolve()] = scene.name

    def find(self, name: str, folder: Path, at: str) -> str:
        """Return the key of the scene that a file in `folder` names, or `OPEN_FLOOR`.

        `at` is where it is named, file and line, for the message of an error.

        Raises:
            ValueError: there is no such scene, its file is not valid, or another one has its key.
            OSError: its file cannot be opened.
        """
        if name == OPEN_FLOOR or name in self.scenes:
            return name
        if name in shipped_scenes():
            return self._add(load_shipped(name), at)
        path = (folder / name).resolve()
        if path in self._files:
            return self._files[path]
        if not path.is_file():
            known = ", ".join(sorted({*shipped_scenes(), *self.scenes}))
            raise ValueError(
                f"{at}: there is no scene {name!r}. Scenes are {known}, and {OPEN_FLOOR!r}; for one"
                f" of your own, give the path of its file, relative to the one that names it."
            )
        try:
            scene = _read_file(path)
        except ValueError as error:
            raise ValueError(f"{at}: scene {error}") from error
        _require_other_key(scene, path, at)
        self._files[path] = self._add(scene, at)
        return scene.name

    def announce(self, name: str, folder: Path, at: str) -> None:
        """Read a scene that is named by its file's path, so that others may name its key.

        Raises:
            ValueError, OSError: as `find`, but a name that is no file is left to that.
        """
        if name != OPEN_FLOOR and name not in shipped_scenes() and (folder / name).is_file():
            self.find(name, folder, at)

    def planned(self) -> WalkedScenes:
        """Return the planners of these scenes, and of those that are found later."""
        return WalkedScenes(self.scenes, self.usual)

    def _add(self, scene: Scene, at: str) -> str:
        if scene.name in self.scenes:
            raise ValueError(
                f"{at}: another scene has the key {scene.name!r}, too. Give this one's file another"
                " key."
            )
        self.scenes[scene.name] = scene
        return scene.name


def _require_other_key(scene: Scene, path: Path, at: str) -> None:
    """Raise ValueError if a scene file has the key of a shipped scene, but is another one."""
    shipped = shipped_scenes().get(scene.name)
    if shipped is not None and shipped.read_bytes() != path.read_bytes():
        raise ValueError(
            f"{at}: {path.name} has the key {scene.name!r}, which is that of a scene of the"
            " product; rows that name it would mean either. Give the file another key."
        )


def _read_file(path: Path) -> Scene:
    try:
        return load_scene(path.read_text(encoding="utf-8-sig"))
    except ConfigError as error:
        problems = "\n".join(
            f"  line {one.line}: {as_sentences(one.message, one.remedy)}" for one in error.problems
        )
        raise ValueError(f"{path}:\n{problems}") from error
    except UnicodeDecodeError as error:
        raise ValueError(f"{path}: not UTF-8 text ({error})") from error
