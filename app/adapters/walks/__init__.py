"""Walks and scenes out of files: the floors people walk on, 2-D tracks, and fitted models.

This face offers scenes. `track_table` and `model_file` are imported by name, and only where tracks
or models are wanted: a server starts without the science behind them.
"""

from app.adapters.walks.scene_file import load_scene, load_shipped, shipped_scenes

__all__ = ["load_scene", "load_shipped", "shipped_scenes"]
