"""Tasks in processes that may crash, hang or leak: how processes start, and the pool that they work in."""
