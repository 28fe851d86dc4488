"""The command `reembody tracking`: trackers of a lab in the world of a headset."""
