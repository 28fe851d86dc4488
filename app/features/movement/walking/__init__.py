"""How people walk, predicted: scenes, sets of walks, models fitted on them, and their answers."""
