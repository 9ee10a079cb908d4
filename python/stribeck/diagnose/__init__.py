"""Which physical effect is missing from a model?"""

from stribeck.diagnose.bound import Explainable
from stribeck.diagnose.floor import NoiseFloor, noise_floor
from stribeck.diagnose.ranking import share_of_unexplained
from stribeck.diagnose.result import Diagnosis, Finding
from stribeck.diagnose.run import LEAST_FALL, diagnose
from stribeck.diagnose.testable import Untestable, untestable
from stribeck.diagnose.unexplained import Unexplained
from stribeck.diagnose.visibility import Group, SmallestVisible

__all__ = [
    "LEAST_FALL",
    "Diagnosis",
    "Explainable",
    "Finding",
    "Group",
    "NoiseFloor",
    "SmallestVisible",
    "Unexplained",
    "Untestable",
    "diagnose",
    "noise_floor",
    "share_of_unexplained",
    "untestable",
]
