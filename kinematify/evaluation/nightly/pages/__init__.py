"""Pages of a night and of all nights; each is one file that loads nothing from elsewhere."""
