"""KV15x: every mesh file, before the model as a whole is read."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.errors import DescriptionError
from kinematify.validation.read import read_model

if TYPE_CHECKING:
    from kinematify.validation.declared import DeclaredModel
    from kinematify.validation.stage import Recorder, StageRequest


def check_mesh_files(request: StageRequest, recorder: Recorder) -> DeclaredModel | None:
    """Check the mesh files and return the model that they belong to, or None where it cannot be read."""
    model = None
    with recorder.check("KV150") as check:
        try:
            model = read_model(request.urdf, package_dirs=request.package_dirs)
        except DescriptionError as error:
            check.find(str(error), "Mend the file that is named.")
    return model
