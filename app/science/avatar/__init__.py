"""Avatars: motor-driven bodies that follow the participant's movement.

Each folder is imported separately, so that importing one loads only what it needs. From lowest to
highest level: `body`, `mannequin`, `configuration`, `mjcf`, `targets`, `ik`, `simulation`,
`tuning`.
"""
