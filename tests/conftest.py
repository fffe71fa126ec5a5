"""Settings that every test file shares: one thread per process and quiet, repeatable hypothesis."""

from __future__ import annotations

import os

# Two test processes share two cores; a numeric library that starts its own threads makes both slower.
# The variable is read when numpy or torch is imported, so it is set before anything else here.
os.environ.setdefault("OMP_NUM_THREADS", "1")

from hypothesis import HealthCheck, settings

settings.register_profile(
    "kinematify", deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow], print_blob=True
)
settings.load_profile("kinematify")
