"""How people walk: steering parameters as distributions over people and paths.

After Agethen, Gaisbauer and Rukzio (2018), "A Probabilistic Steering Parameter Model for
Deterministic Motion Planning Algorithms".

The lower half turns recordings into suitability maps:

    model        Track -> Walk, PlannedPath, PlannedWalk: the records everything here exchanges
    tracks, capture_tracks, segmentation, walks, census     from captures to entries
    parameters   bounded steering parameters and the grid over them
    protocols    Planner, PathFollower, Metric: what can be exchanged
    scene        floor, obstacles, places and the paths between them; laboratory: the paper's
    grid_planner Lazy Theta*; visibility: the shortest paths, to check it against
    following    the agent that is steered by velocity, acceleration, angular; metrics
    suitability  DeviationMap and its reading as suitability
    maps         all maps of a database, with progress, stop and resume

All lengths are metres, all times seconds. The floor is seen from above: x to the right, y ahead
(the world's -z), angles counter-clockwise.
"""
