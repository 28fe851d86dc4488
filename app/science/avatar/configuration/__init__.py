"""What a laboratory sets: limits, gains, colliders and layers, joint by joint."""
