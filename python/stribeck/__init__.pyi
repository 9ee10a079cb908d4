from . import robot
from .base.errors import (
    FitError,
    ModelFileError,
    ProjectError,
    RecordingError,
    SpecError,
    StribeckError,
)
from .base.version import __version__
from .diagnosis.compare import Comparison, compare
from .diagnosis.diagnose import diagnose
from .diagnosis.loop.add import Addition, add
from .diagnosis.loop.improve import Improvement, improve
from .diagnosis.result import Diagnosis, Finding
from .exporters.export import Export, export
from .fitting.evaluate import evaluate
from .fitting.fit import fit
from .fitting.methods.arm_load import planar_arm_load
from .fitting.protocols.found import Protocol, found_protocols
from .fitting.result import Fit
from .fitting.transmission.measure import Transmission, measure_transmission
from .identify.errors.estimates import Estimate
from .models.build import law, model
from .models.catalog import catalog, effects, laws
from .models.model import Model
from .models.model_file import ModelFile
from .models.parameter import Parameter
from .models.published.sets import PublishedSet, published, published_sets
from .models.reader import load, read_model_file
from .motion.compensate.controller import HInfinity
from .motion.compensate.factor import largest_factor
from .motion.compensate.loop import Compensator
from .motion.compensate.teaching import teach
from .motion.compensate.tracking import Tracking, compensate
from .motion.design.plan import plan
from .motion.design.result import Plan
from .motion.simulate.joint import Joint
from .motion.simulate.result import Simulation
from .motion.simulate.run import simulate
from .passivity.certificate import Certificate
from .passivity.check import check
from .projects.project import Project, project
from .recording.load import read
from .recording.recording import Recording
from .recording.several.concat import concat
from .report.plots.draw import plot
from .scale.fleet.fleet import fleet
from .scale.fleet.result import Fleet
from .scale.robots.stream import RobotStream, stream_robot
from .scale.streaming.result import StreamedFit
from .scale.streaming.stream import Stream, stream

__all__ = [
    "Addition",
    "Certificate",
    "Comparison",
    "Compensator",
    "Diagnosis",
    "Estimate",
    "Export",
    "Finding",
    "Fit",
    "FitError",
    "Fleet",
    "HInfinity",
    "Improvement",
    "Joint",
    "Model",
    "ModelFile",
    "ModelFileError",
    "Parameter",
    "Plan",
    "Project",
    "ProjectError",
    "Protocol",
    "PublishedSet",
    "Recording",
    "RecordingError",
    "RobotStream",
    "Simulation",
    "SpecError",
    "Stream",
    "StreamedFit",
    "StribeckError",
    "Tracking",
    "Transmission",
    "__version__",
    "add",
    "catalog",
    "check",
    "compare",
    "compensate",
    "concat",
    "diagnose",
    "effects",
    "evaluate",
    "export",
    "fit",
    "fleet",
    "found_protocols",
    "improve",
    "largest_factor",
    "law",
    "laws",
    "load",
    "measure_transmission",
    "model",
    "plan",
    "planar_arm_load",
    "plot",
    "project",
    "published",
    "published_sets",
    "read",
    "read_model_file",
    "robot",
    "simulate",
    "stream",
    "stream_robot",
    "teach",
]
