"""KV7xx: a robot uses the object: it reaches, grasps and pulls (design section 4)."""
