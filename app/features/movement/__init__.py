"""Bodies and how they move: captures, humanoid models, the physics avatar, walking."""
