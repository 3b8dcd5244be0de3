"""The thesis' method: reference contours of unit errors, linear least squares on them, its tables.

A documented mode for comparison with the thesis (sections 3.4, 5-2, 5-3); to fit a machine, use `hexdbb.diagnosis`.
All kinematics are the engine's.
"""

from hexdbb.studies.thesis.circular_test import CircularTest, circle_test, joint_plane_test, plan_test, record_test
from hexdbb.studies.thesis.contours import ReferenceContours, harmonic_amplitudes, reference_contours
from hexdbb.studies.thesis.estimator import ThesisEstimate, thesis_estimate, thesis_estimate_record
from hexdbb.studies.thesis.unknowns import GEOMETRIC_ERRORS, UNKNOWNS, Unknown, find_unknowns

__all__ = [
    "GEOMETRIC_ERRORS",
    "UNKNOWNS",
    "CircularTest",
    "ReferenceContours",
    "ThesisEstimate",
    "Unknown",
    "circle_test",
    "find_unknowns",
    "harmonic_amplitudes",
    "joint_plane_test",
    "plan_test",
    "record_test",
    "reference_contours",
    "thesis_estimate",
    "thesis_estimate_record",
]
