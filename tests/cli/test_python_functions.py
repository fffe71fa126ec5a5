"""Every command has its function in `kinematify`, with the same names and defaults."""

from __future__ import annotations

import importlib
import inspect

import click
import pytest

import kinematify

FUNCTIONS = {
    "generate": ["a cabinet"],
    "infer": ["parts", "-o", "out"],
    "refine": ["folder"],
    "validate": ["model.urdf"],
    "fix": ["model.urdf", "-o", "out.urdf"],
    "view": ["model.urdf"],
    "export": ["model.urdf", "--to", "mjcf", "-o", "out.xml"],
    "batch": ["a.glb", "-o", "out"],
    "bench": [],
    "nightly": [],
}
"""Commands with their shortest arguments."""
REQUIRED = {"assembly", "model", "models", "out", "to", "inputs", "words", "text"}
"""What is given above, or a path there and its text here."""
TERMINAL = {
    "generate": {"json_to", "words", "schema", "listing"},  # the sentence is `text`; the others list what there is
    "infer": {"json_to"},
    "refine": {"json_to"},
    # several models, files of reports (`kinematify.write_reports`), and what is shown
    "validate": {"json", "junit", "sarif", "html", "suggest_accept", "fail_on", "everything", "models"},
    "fix": {"json_to"},
    "view": {"joints", "values"},  # pairs of q
    "export": {"json_to"},
    "batch": {"json_to"},
    "bench": {"json_to"},
    "nightly": {"json_to", "accepted"},  # `evaluation.nightly.run_night.accept` runs nothing
}
"""Options that are of the terminal alone."""
PYTHON = {
    "infer": {"settings", "progress"},
    "generate": {"progress"},
    "refine": {"settings", "progress"},
    "validate": {"model", "arguments", "progress"},  # arguments stand among the models on the command line
    "fix": {"config", "settings", "workers", "progress"},
    "view": {"q"},
    "export": {"settings", "progress"},
    "batch": {"settings", "progress"},
    "bench": {"progress"},
    "nightly": {"infer", "progress"},  # a function under test
}
"""Parameters that are of Python alone: typed settings and callbacks."""


def test_every_function_is_public() -> None:
    assert set(FUNCTIONS) <= set(kinematify.__all__)


@pytest.mark.parametrize("name", FUNCTIONS)
def test_options_are_parameters(name: str) -> None:
    command: click.Command = importlib.import_module(f"kinematify.cli.{name}").command
    options = command.make_context(name, list(FUNCTIONS[name])).params
    parameters = inspect.signature(getattr(kinematify, name)).parameters
    assert set(options) - TERMINAL[name] == set(parameters) - PYTHON[name]
    for option in set(options) - TERMINAL[name] - REQUIRED:
        assert parameters[option].default == options[option], option
