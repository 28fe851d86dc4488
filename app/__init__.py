"""Run, watch and analyse VR re-embodiment studies."""

__version__ = "0.1.0"
