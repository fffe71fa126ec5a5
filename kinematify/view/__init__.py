"""A model in a browser, to move and to look at; called as a function, the package shows one."""
