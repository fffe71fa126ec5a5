"""A model in a browser, to move and to look at: `kinematify view`."""
