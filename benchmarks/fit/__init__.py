"""How the choice of joints is fitted: corpora, examples, trees, and what is judged on held-out objects."""
