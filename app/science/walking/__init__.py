"""How people walk: steering parameters as distributions over people and paths.

After Agethen, Gaisbauer and Rukzio (2018), "A Probabilistic Steering Parameter Model for
Deterministic Motion Planning Algorithms".

Each folder is a face of its own. From the bottom:

    records      Track -> Walk, PlannedPath, PlannedWalk: what everything here exchanges; bounded
                 steering parameters and the grid over them; Planner, PathFollower, Metric
    scene        floor, obstacles, places and the paths between them; the paper's laboratory
    recording    from captures to entries
    planning     Lazy Theta*
    following    the agent that is steered by velocity, acceleration, angular; metrics
    maps         suitability maps of a database, and what lies between them
    models       distributions fitted to the maps, and predictions from them
    synthetic    populations to try it on
    evaluation   predictions against walks that a model has not seen

All lengths are metres, all times seconds. The floor is seen from above: x to the right, y ahead
(the world's -z), angles counter-clockwise.
"""
