"""Trajectory evaluation: association, rigid alignment, ATE, RPE, completion, plots."""

from vsgraphs.evaluate.alignment import umeyama
from vsgraphs.evaluate.association import MAX_DT_S, associate
from vsgraphs.evaluate.evaluation import Evaluation, completion_of, evaluate

__all__ = ["MAX_DT_S", "Evaluation", "associate", "completion_of", "evaluate", "umeyama"]
