"""Lines and directions that geometry proposes."""
