"""Psychophysics: psychometric functions, thresholds, courses of procedures, and binary answers by a factor."""

from __future__ import annotations

from collections.abc import Iterator

from ..data import Data
from ..means import wilson
from ..saving import Plan
from .answers import answers_by_level, draw_answers, plan_of_answers
from .courses import draw_procedure_courses, plans_of_courses, procedure_courses
from .functions import draw_psychometric_functions, plans_of_functions, probability, psychometric_functions
from .procedures import answers_of, procedures_of
from .thresholds import draw_thresholds, plans_of_thresholds, thresholds_by_procedure

__all__ = [
    "HEADING", "answers_by_level", "draw_answers", "draw_procedure_courses", "draw_psychometric_functions", "draw_thresholds",
    "plan_of_answers", "plans", "probability", "procedure_courses", "psychometric_functions", "thresholds_by_procedure", "wilson",
]  # fmt: skip

#: Heading above these figures in a report.
HEADING = "Thresholds"


def plans(data: Data) -> Iterator[Plan]:
    """Figures of the task's procedures or, if it has none, of binary answers by a numeric factor."""
    procedures = [each for each in procedures_of(data) if len(answers_of(data, each))]
    if procedures:
        yield from plans_of_functions(data, procedures)
        yield from plans_of_thresholds(data, procedures)
        yield from plans_of_courses(data, procedures)
    yield from plan_of_answers(data)
