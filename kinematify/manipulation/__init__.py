"""A robot uses an articulated object: grasp, plan, execute."""
