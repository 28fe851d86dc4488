"""Work with recorded data: analysis, exports, replay, preregistration and imported answers."""
