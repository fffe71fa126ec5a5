"""Answers of a vision-language model about joints, added to what the geometry says (paper section III-D)."""
