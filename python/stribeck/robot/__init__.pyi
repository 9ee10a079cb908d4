from .arm import Robot, RobotJoint, Sphere
from .compare import RobotComparison, compare_robots
from .describe import read_robot
from .diagnosis import RobotDiagnosis
from .drive_gains import DriveGain, KnownPayload
from .fit import fit_robot
from .follow import RobotTracking, follow_robot
from .improve import RobotImprovement, improve_robot
from .motion import RobotMotion, read_motion
from .plan import RobotPlan, plan_robot
from .result import RobotFit
from .simulate import simulate_robot
from .stored import read_friction, write_robot
from .tables import from_tables
from .updated_mjcf import write_mjcf
from .updated_urdf import write_urdf

__all__ = [
    "DriveGain",
    "KnownPayload",
    "Robot",
    "RobotComparison",
    "RobotDiagnosis",
    "RobotFit",
    "RobotImprovement",
    "RobotJoint",
    "RobotMotion",
    "RobotPlan",
    "RobotTracking",
    "Sphere",
    "compare_robots",
    "fit_robot",
    "follow_robot",
    "from_tables",
    "improve_robot",
    "plan_robot",
    "read_friction",
    "read_motion",
    "read_robot",
    "simulate_robot",
    "write_mjcf",
    "write_robot",
    "write_urdf",
]
