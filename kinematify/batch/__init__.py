"""Many objects: tasks in processes that may crash, on this machine or on a cluster, and `kinematify batch`.

Called as a function, the package converts a library, as the command does.
"""
