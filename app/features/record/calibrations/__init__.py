"""How slow the equipment itself is: measurements of its motion-to-photon delay."""
