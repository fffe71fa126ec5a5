"""What a vision-language model says of joints, added to what the geometry says (paper section III-D)."""
