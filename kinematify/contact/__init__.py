"""An assembly becomes a contact graph with clusters of congruent parts."""
