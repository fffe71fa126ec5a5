"""Settings that every test file shares: one thread per process and quiet, repeatable hypothesis."""

from __future__ import annotations

import os

# Two test processes share two cores; a numeric library that starts its own threads makes both slower.
# The variable is read when numpy or torch is imported, so it is set before anything else here.
os.environ.setdefault("OMP_NUM_THREADS", "1")

from collections.abc import Generator

import pytest
from hypothesis import HealthCheck, settings

from kinematify.errors import EnvironmentFault
from kinematify.versions import is_installed

settings.register_profile(
    "kinematify", deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow], print_blob=True
)
settings.load_profile("kinematify")


@pytest.hookimpl(wrapper=True)
def pytest_pyfunc_call(pyfuncitem: pytest.Function) -> Generator[None, object, object]:
    """Skip a test that asks for PyBullet where it is not installed: it has no wheels for Python 3.12 and later."""
    try:
        return (yield)
    except (EnvironmentFault, ModuleNotFoundError) as error:
        if is_installed("pybullet") or "pybullet" not in str(error):
            raise
        pytest.skip(f"{pyfuncitem.name}: {error}")
