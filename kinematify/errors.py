"""Every exception that Kinematify raises on purpose.

KinematifyError
├── InputError            unusable input: exit status 2
│   ├── AssemblyError     the meshes cannot become an assembly
│   ├── DescriptionError  a URDF cannot be read
│   ├── ConfigError       a configuration is unknown or malformed
│   └── OutputError       the output folder exists or cannot be written
├── ExportError           a target does not read the model that was written: exit status 1
└── EnvironmentFault      an engine or package is missing or failed: exit status 3

A message is one paragraph that says what was given, what was expected and what to do.
"""

from __future__ import annotations

from enum import IntEnum


class ExitStatus(IntEnum):
    """Exit status of the command line."""

    FINE = 0
    FAILURES = 1
    """It ran and found failures."""
    UNUSABLE = 2
    """The input or an argument cannot be used."""
    FAULT = 3
    """An engine, the machine or Kinematify itself failed, or time ran out before an answer."""
    INTERRUPTED = 130


class KinematifyError(Exception):
    """Base class; `exit_status` is what the command line ends with."""

    exit_status = ExitStatus.UNUSABLE


class InputError(KinematifyError):
    """The input or an argument cannot be used."""


class AssemblyError(InputError):
    """The given meshes cannot become an assembly of rigid parts."""


class DescriptionError(InputError):
    """A robot description (URDF) cannot be read."""


class ConfigError(InputError):
    """A configuration file is unknown, malformed or holds a value out of range."""


class OutputError(InputError):
    """The output place exists already or cannot be written."""


class ExportError(KinematifyError):
    """A target refuses the file that was written for it, or reads another model in it."""

    exit_status = ExitStatus.FAILURES


class EnvironmentFault(KinematifyError):
    """An engine or an optional package is missing or failed."""

    exit_status = ExitStatus.FAULT
