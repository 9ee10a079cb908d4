"""What people see: text for the terminal, figures and pages.

A result names no renderer; the table below does. It loads nothing: a module of this room is
imported when a result that it renders is first shown, matplotlib when a figure is drawn.
"""

from stribeck.base.shown import register

#: Renderers by class and kind, in modules of this room.
RENDERERS: dict[str, dict[str, str]] = {
    "stribeck.recording.recording:Recording": {
        "text": "recording:recording_text",
        "figure": "recording_figure:recording_figure",
        "notebook": "notebooks.results:recording_view",
    },
    "stribeck.diagnosis.inspect:Inspection": {
        "text": "inspection:inspection_text",
        "notebook": "notebooks.tables:inspection_view",
    },
    "stribeck.models.model:Model": {
        "text": "model:model_text",
        "notebook": "notebooks.tables:model_view",
    },
    "stribeck.exporters.export:Export": {
        "text": "model:export_text",
        "notebook": "notebooks.tables:words_view",
    },
    "stribeck.fitting.result:Fit": {
        "text": "fit:fit_text",
        "figure": "fit:fit_figure",
        "notebook": "notebooks.results:fit_view",
    },
    "stribeck.robot.arm:Robot": {
        "text": "robot:robot_text",
        "notebook": "notebooks.tables:words_view",
    },
    "stribeck.robot.result:RobotFit": {
        "text": "robot:robot_fit_text",
        "notebook": "notebooks.tables:robot_fit_view",
    },
    "stribeck.robot.follow:RobotTracking": {
        "text": "robot_tracking:robot_tracking_text",
        "notebook": "notebooks.tables:robot_tracking_view",
    },
    "stribeck.robot.plan:RobotPlan": {
        "text": "robot:robot_plan_text",
        "notebook": "notebooks.tables:robot_plan_view",
    },
    "stribeck.robot.compare:RobotComparison": {
        "text": "robot:robot_comparison_text",
        "notebook": "notebooks.results:frame_view",
    },
    "stribeck.robot.diagnosis:RobotDiagnosis": {
        "text": "robot:robot_diagnosis_text",
        "notebook": "notebooks.tables:robot_diagnosis_view",
    },
    "stribeck.robot.improve:RobotImprovement": {
        "text": "robot:robot_improvement_text",
        "notebook": "notebooks.tables:robot_improvement_view",
    },
    "stribeck.fitting.methods.arm:ArmFit": {
        "text": "methods:arm_text",
        "notebook": "notebooks.results:frame_view",
    },
    "stribeck.fitting.protocols.points:BristleStiffness": {
        "text": "methods:stiffness_text",
        "notebook": "notebooks.tables:words_view",
    },
    "stribeck.fitting.transmission.measure:Transmission": {
        "text": "transmission:transmission_text",
        "notebook": "notebooks.tables:words_view",
    },
    "stribeck.fitting.methods.steady:SteadyPoints": {
        "text": "methods:points_text",
        "notebook": "notebooks.results:frame_view",
    },
    "stribeck.passivity.certificate:Certificate": {
        "text": "certificate:certificate_text",
        "notebook": "notebooks.tables:certificate_view",
    },
    "stribeck.diagnosis.compare:Comparison": {
        "text": "comparison:comparison_text",
        "figure": "comparison:comparison_figure",
        "notebook": "notebooks.results:comparison_view",
    },
    "stribeck.diagnosis.result:Finding": {
        "text": "diagnosis:finding_text",
        "figure": "finding:finding_figure",
        "notebook": "notebooks.results:finding_view",
    },
    "stribeck.diagnosis.result:Diagnosis": {
        "text": "diagnosis:diagnosis_text",
        "figure": "diagnosis:diagnosis_figure",
        "notebook": "notebooks.results:diagnosis_view",
    },
    "stribeck.diagnosis.loop.add:Addition": {
        "text": "improvement:addition_text",
        "notebook": "notebooks.results:addition_view",
    },
    "stribeck.diagnosis.loop.improve:Improvement": {
        "text": "improvement:improvement_text",
        "figure": "improvement_figure:improvement_figure",
        "notebook": "notebooks.results:improvement_view",
    },
    "stribeck.motion.simulate.result:Simulation": {
        "text": "simulation:simulation_text",
        "figure": "simulation:simulation_figure",
        "notebook": "notebooks.results:picture_view",
    },
    "stribeck.motion.simulate.validation:Validation": {
        "text": "simulation:validation_text",
        "figure": "simulation:validation_figure",
        "notebook": "notebooks.results:picture_view",
    },
    "stribeck.motion.compensate.tracking:Tracking": {
        "text": "compensation:tracking_text",
        "figure": "compensation:tracking_figure",
        "notebook": "notebooks.results:picture_view",
    },
    "stribeck.motion.compensate.factor:Factor": {
        "text": "compensation:factor_text",
        "notebook": "notebooks.tables:words_view",
    },
    "stribeck.motion.compensate.teaching:Teaching": {
        "text": "compensation:teaching_text",
        "notebook": "notebooks.tables:words_view",
    },
    "stribeck.motion.design.result:Plan": {
        "text": "design:plan_text",
        "figure": "design:plan_figure",
        "notebook": "notebooks.results:plan_view",
    },
    "stribeck.scale.streaming.result:StreamedFit": {
        "text": "streaming:streamed_fit_text",
        "notebook": "notebooks.results:frame_view",
    },
    "stribeck.scale.streaming.diagnosis:StreamedDiagnosis": {
        "text": "streaming:streamed_diagnosis_text",
        "notebook": "notebooks.tables:words_view",
    },
    "stribeck.scale.streaming.improvement:StreamedImprovement": {
        "text": "streaming:streamed_improvement_text",
        "notebook": "notebooks.tables:words_view",
    },
    "stribeck.scale.study.result:Study": {
        "text": "study:study_text",
        "figure": "study_figure:error_figure",
        "friction_figure": "study_figure:friction_figure",
        "notebook": "notebooks.results:frame_view",
    },
    "stribeck.scale.fleet.result:Fleet": {
        "text": "fleet:fleet_text",
        "figure": "fleet_figure:fleet_figure",
        "notebook": "notebooks.results:fleet_view",
    },
    "stribeck.projects.project:Project": {
        "text": "project:project_text",
        "figure": "project:project_figure",
        "notebook": "notebooks.tables:project_view",
    },
    "stribeck.projects.sides:Sides": {
        "text": "project:sides_text",
        "figure": "project:sides_figure",
        "notebook": "notebooks.results:sides_view",
    },
}


def register_renderers() -> None:
    """Make every result of the package printable; the package does it when it is imported."""
    for shown, renderers in RENDERERS.items():
        register(shown, **{kind: f"{__name__}.{name}" for kind, name in renderers.items()})
