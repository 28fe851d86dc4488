"""Read scenes, 2-D walking tracks and fitted walking models from files.

This package exports scenes only. `track_table` and `model_file` are imported separately, only where
tracks or models are needed: a server starts without the science they depend on.
"""

from app.adapters.walks.scene_file import load_scene, load_shipped, shipped_scenes

__all__ = ["load_scene", "load_shipped", "shipped_scenes"]
