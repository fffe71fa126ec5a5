"""Text or a picture becomes an assembly of rigid parts; called as a function, the package writes a model."""

from __future__ import annotations

import sys
from types import ModuleType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

    from kinematify.config import Config
    from kinematify.model.kinematic_model import KinematicModel


class _Package(ModuleType):
    """The package as a function: `kinematify.generate` is both."""

    def __call__(
        self,
        text: str,
        out: str | Path,
        *,
        seed: int | None = None,
        strict: bool = True,
        overwrite: bool = False,
        config: Config | None = None,
    ) -> KinematicModel:
        """Write the model folder of what a sentence describes, with its exact joints.

        Args:
            text: English, e.g. ``a cabinet with two doors``.
            out: Folder to make; it appears whole or not at all.
            seed: Draws what is not asked for; the usual values if absent.
            strict: Refuse a sentence of which something cannot be built.
            overwrite: Replace an earlier model folder.
            config: All stages, the default ones if absent.

        Returns:
            The model that was written.

        Raises:
            InputError: The sentence cannot be built, or with `strict` not all of it.
            OutputError: `out` exists and must not be replaced, or cannot be written.
        """
        from kinematify.generate.blueprint_files import write_described  # noqa: PLC0415 - the library takes a second

        return write_described(text, out, seed=seed, strict=strict, overwrite=overwrite, config=config)


generate = sys.modules[__name__]
generate.__class__ = _Package
