"""Many objects: tasks in processes that may crash, on this machine or on a cluster, and `kinematify batch`."""
