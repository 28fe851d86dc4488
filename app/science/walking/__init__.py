"""How people walk: steering parameters as distributions over people and paths.

After Agethen, Gaisbauer and Rukzio (2018), "A Probabilistic Steering Parameter Model for
Deterministic Motion Planning Algorithms".

Each folder has its own public interface. From the bottom:

    records      Track -> Walk, PlannedPath, PlannedWalk: the data types that all folders share;
                 bounded steering parameters and their grid; Planner, PathFollower, Metric
    scene        floor, obstacles, places and the paths between them; the paper's laboratory
    recording    from captures to entries of the database
    planning     Lazy Theta*
    following    the agent that is steered by velocity, acceleration, angular; metrics
    maps         suitability maps of a database, and the interpolation between them
    travel_times curves of travel time over path length, with effects of people
    models       distributions fitted to the maps and to travel times, and predictions from them
    synthetic    synthetic populations for tests and demonstrations
    evaluation   comparison of predictions with walks that a model was not fitted on

All lengths are metres, all times seconds. The floor is seen from above: x to the right, y ahead
(the world's -z), angles counter-clockwise.
"""
