"""Build the pages (`frontend/` into `app/static/`) for every wheel, sdist or editable install."""

import os
import sys
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

# The build backend loads this file alone, from any working directory.
sys.path.insert(0, str(Path(__file__).resolve().parent))
from build_pages import PagesError, build_pages, say


class PagesBuildHook(BuildHookInterface):  # type: ignore[type-arg]  # its parameter is hatchling's own
    """Hatchling's hook, whose `initialize` is called before the files of a target are collected."""

    PLUGIN_NAME = "custom"

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:  # noqa: ARG002
        """Build the pages unless they are current.

        `REEMBODY_SKIP_FRONTEND` skips this for an editable installation.
        """
        root = Path(self.root)
        if version == "editable" and os.environ.get("REEMBODY_SKIP_FRONTEND"):
            say("the pages are left as they are (REEMBODY_SKIP_FRONTEND is set)")
            return
        try:
            build_pages(root / "frontend", root / "app" / "static")
        except PagesError as error:
            # Show npm's output, not the build backend's traceback.
            raise SystemExit(f"reembody: {error}") from None
