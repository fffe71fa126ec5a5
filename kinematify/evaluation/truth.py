"""Generated objects know their joints: what was inferred from their parts is scored against them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.evaluation.metrics import score_object
from kinematify.evaluation.prediction import prediction_of
from kinematify.generate.procedural.blueprint import ground_truth

if TYPE_CHECKING:
    from kinematify.evaluation.metrics import ObjectScore
    from kinematify.generate.procedural.blueprint import Blueprint
    from kinematify.pipeline import Inference


def score_blueprint(blueprint: Blueprint, inference: Inference) -> ObjectScore:
    """Compare an inference from the parts of a blueprint with the joints that it was built with."""
    truth = ground_truth(blueprint)
    index = {name: number for number, name in enumerate(truth.part_names)}
    return score_object(
        truth,
        prediction_of(inference.trees[0], inference.joints, inference.assembly.names, index),
        centroids=[part.centroid for part in blueprint.parts],
        diagonal=blueprint.assembly.diagonal,
    )
