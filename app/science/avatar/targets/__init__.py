"""From a pose to what the motors are asked for."""
